// Inputs with a valid form but wrong contents: robots, tasks, volumes and configurations made of the right
// words in the wrong places, with the wrong numbers.
#include "test/fuzz/structured.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/posture/task.h"
#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/constraints.h"
#include "test/fuzz/clouds.h"
#include "test/fuzz/property.h"
#include "test/fuzz/target.h"
#include "test/robot/urdf_texts.h"

namespace fcl_stpbv::fuzz {

using Eigen::Vector3d;
using nlohmann::json;
using test::Random;

namespace {

template <class List>
auto one(const List& list, Random& random) {
  return list[static_cast<std::size_t>(random.below(static_cast<int>(std::size(list))))];
}

std::string numberText(Random& random) {
  static const char* const strange[] = {"nan",    "inf",   "-inf", "1e400", "-1", "0",
                                        "1e-320", "1e300", "1,5",  "",      "x"};
  return random.below(8) ? std::to_string(random.uniform(-2, 2)) : one(strange, random);
}
std::string numbersText(int count, Random& random) {
  std::string text;
  for (int i = random.below(20) ? count : random.below(6); i > 0; --i)
    text += numberText(random) + (i > 1 ? " " : "");
  return text;
}
std::string attribute(const std::string& name, const std::string& value, Random& random) {
  if (random.below(40) == 0) return "";
  const std::string once = " " + (random.below(60) ? name : name + "s") + "=\"" + value + "\"";
  return random.below(60) ? once : once + once;
}

std::string geometryText(Random& random) {
  const auto size = [&] {
    return random.below(12) ? std::to_string(random.uniform(0.01, 0.3)) : numberText(random);
  };
  switch (random.below(5)) {
    case 0:
      return "<box" + attribute("size", size() + " " + size() + " " + size(), random) + "/>";
    case 1:
      return "<cylinder" + attribute("radius", size(), random) + attribute("length", size(), random) + "/>";
    case 2:
      return "<capsule" + attribute("radius", size(), random) + attribute("length", size(), random) + "/>";
    case 3:
      return random.below(4) ? "<sphere" + attribute("radius", size(), random) + "/>"
                             : "<mesh filename=\"none.stl\"/>";
    default:
      return random.below(8) ? "<sphere radius=\"0.1\"/>" : "";
  }
}

std::string linkText(int index, int count, Random& random) {
  std::string text =
      "<link" +
      attribute("name", "l" + std::to_string(random.below(30) ? index : random.below(count)), random) + ">";
  for (int shapes = random.below(4); shapes > 0; --shapes) {
    const std::string word =
        random.below(30) ? "collision"
                         : one(std::array<const char*, 3>{"collisions", "Collision", "visual"}, random);
    text += "<" + word + ">";
    if (random.below(2))
      text += "<origin" + attribute("xyz", numbersText(3, random), random) +
              attribute("rpy", numbersText(3, random), random) + "/>";
    text += "<geometry>" + geometryText(random) + (random.below(30) ? "" : geometryText(random)) +
            "</geometry></" + word + ">";
  }
  return text + "</link>\n";
}

std::string jointText(int index, int count, Random& random) {
  static const char* const types[] = {"revolute", "prismatic", "continuous", "fixed",
                                      "planar",   "floating",  "hinge"};
  const auto link = [&](int usual) {
    return "l" + std::to_string(random.below(25) ? usual : random.below(count + 1));
  };
  std::string text = "<joint" + attribute("name", "j" + std::to_string(index), random) +
                     attribute("type", one(types, random), random) + ">";
  text += "<parent" + attribute("link", link(random.below(index + 1)), random) + "/><child" +
          attribute("link", link(index + 1), random) + "/>";
  if (random.below(2)) text += "<origin" + attribute("xyz", numbersText(3, random), random) + "/>";
  if (random.below(3))
    text += "<axis" + attribute("xyz", random.below(4) ? "0 0 1" : numbersText(3, random), random) + "/>";
  if (random.below(10))
    text += "<limit" + attribute("lower", random.below(4) ? "-1" : numberText(random), random) +
            " upper=\"1\" effort=\"1\" velocity=\"1\"/>";
  if (random.below(4) == 0)
    text += "<mimic" + attribute("joint", "j" + std::to_string(random.below(count)), random) +
            attribute("multiplier", numberText(random), random) + "/>";
  return text + "</joint>\n";
}

/// Two bodies on hinges and a third one beside them, with which everything else is tested.
struct Scene {
  PostureScene scene;
  std::shared_ptr<const Kinematics> kinematics;
  std::unique_ptr<CollisionConstraints> constraints;

  Scene() {
    using namespace test;
    const std::string text = robot(
        link("base", "<box size=\"0.1 0.2 0.3\"/>") +
        link("arm", "<cylinder radius=\"0.1\" length=\"0.5\"/>") + link("hand", "<sphere radius=\"0.1\"/>") +
        joint("shoulder", "revolute", "base", "arm", "<origin xyz=\"0 0 1\"/><axis xyz=\"0 1 0\"/>") +
        joint("wrist", "prismatic", "arm", "hand", "<origin xyz=\"0 0 1\"/><axis xyz=\"0 0 1\"/>"));
    scene.robot = std::make_shared<const RobotModel>(parseUrdf(text, "fuzz.urdf"));
    GeometryOptions options;
    options.cacheFolder.clear();
    RobotGeometry bodies = loadGeometry(*scene.robot, options);
    const std::vector<CheckedPair> pairs = selfPairs(*scene.robot, bodies, nullptr);
    coverPrimitives(pairs, bodies);
    scene.geometry = std::make_shared<const RobotGeometry>(std::move(bodies));
    scene.selfPairs = pairs;
    kinematics = std::make_shared<const Kinematics>(scene.robot, BaseMotion::floating);
    constraints = std::make_unique<CollisionConstraints>(kinematics, scene.geometry, pairs);
  }
};
Scene& scene() {
  static Scene all;
  return all;
}

/// Puts another value or another name somewhere into the tree, or removes a part.
void mutate(json& tree, Random& random) {
  if (tree.is_structured() && !tree.empty() && random.below(5)) {
    auto at = tree.begin();
    std::advance(at, random.below(static_cast<int>(tree.size())));
    return mutate(*at, random);
  }
  static const json values[] = {nullptr,
                                true,
                                -1,
                                0,
                                1e300,
                                "",
                                "hand",
                                "j",
                                json::array(),
                                json::object(),
                                json::array({1, 2, 3}),
                                std::numeric_limits<std::uint64_t>::max()};
  if (tree.is_object() && random.below(2))
    tree[random.below(2) ? "link" : "placement"] = one(values, random);
  else
    tree = one(values, random);
}

}  // namespace

std::string randomRobot(Random& random) {
  const int links = 1 + random.below(6);
  std::string text;
  for (int i = 0; i < links; ++i) text += linkText(i, links, random);
  for (int i = 0; i + 1 < links; ++i) text += jointText(i, links, random);
  return test::robot(text);
}

void checkRobot(const std::string& text, const std::string&) {
  RobotModel model;
  if (!accepted([&] { model = parseUrdf(text, "fuzz.urdf"); })) return;
  int shapes = 0;
  for (const LinkModel& link : model.links)
    for (const ShapeModel& shape : link.collision) {
      shapes += shape.elements;
      must(shape.pose.matrix().allFinite() && shape.size.allFinite(), "a shape that is not finite");
    }
  must(shapes == test::collisionsIn(text), "a <collision> that is not in the model");
  const Kinematics kinematics(std::make_shared<const RobotModel>(model));
  Kinematics::State state = kinematics.makeState();
  kinematics.forward(kinematics.neutral(), state);
  for (const Eigen::Isometry3d& pose : state.link) must(pose.matrix().allFinite(), "a link that is nowhere");
}

std::string randomVolume(Random& random) {
  for (;;) try {
      const CloudCase c = nastyCloud(random);
      const StpBv::Ptr volume = StpBv::build(c.points, c.radii);
      std::vector<Vector3d> vertices = volume->vertices();
      std::vector<StpBv::Ring> faces = volume->faces();
      Radii radii = volume->radii();
      const auto vertex = [&] { return random.below(static_cast<int>(vertices.size())); };
      const auto face = [&]() -> StpBv::Ring& {
        return faces[static_cast<std::size_t>(random.below(static_cast<int>(faces.size())))];
      };
      for (int times = random.below(3); times > 0 && !faces.empty(); --times) switch (random.below(8)) {
          case 0: {
            StpBv::Ring& ring = face();
            std::reverse(ring.begin(), ring.end());
            break;
          }
          case 1:
            face()[0] = vertex();
            break;
          case 2:
            faces.push_back(face());
            break;
          case 3:
            face() = faces.back();
            faces.pop_back();
            break;
          case 4:
            vertices[static_cast<std::size_t>(vertex())] *= random.uniform(0.9, 1.1);
            break;
          case 5:
            vertices.push_back(vertices[static_cast<std::size_t>(vertex())]);
            break;
          case 6:
            radii.R *= random.uniform(0.5, 2);
            break;
          default:
            radii.r = random.uniform(0, 2 * radii.R);
            break;
        }
      std::ostringstream out;
      out.precision(17);
      out << "stpbv 1\nr " << radii.r << "\nR " << radii.R << "\nvertices " << vertices.size() << "\n";
      for (const Vector3d& v : vertices) out << v.x() << " " << v.y() << " " << v.z() << "\n";
      out << "faces " << faces.size() << "\n";
      for (const StpBv::Ring& ring : faces) {
        out << ring.size();
        for (const int i : ring) out << " " << i;
        out << "\n";
      }
      return out.str() + "end\n";
    } catch (const Error&) {  // not every cloud makes a volume
    }
}

void checkVolume(const std::string& text, const std::string&) {
  std::istringstream in(text);
  StpBv::Ptr volume;
  if (!accepted([&] { volume = loadStpBv(in, "fuzz"); })) return;
  // Every volume that was loaded contains all its vertices with the margin around them.
  double size = volume->enclosingRadius();
  for (const Vector3d& p : volume->vertices()) size = std::max(size, p.norm());
  const double rounding = 1e-9 * size + 1e-14 * volume->radii().R;
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Vector3d n = random.direction();
    const double h = volume->support(n);
    must(std::isfinite(h), "a support value that is no number");
    for (const Vector3d& p : volume->vertices())
      must(n.dot(p) + volume->radii().r <= h + rounding, "a vertex sticks out");
  }
}

std::string randomTask(Random& random) {
  json task = json::parse(
      R"({"base": "fixed", "start": {"joints": {"shoulder": 0.5}}, "cost": {"reference": "start", "weights": {"wrist": 2}},
"placements": [{"link": "hand", "target": {"position": [0.1, 0, 2]}}], "contacts": [{"link": "base", "points": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}],
"stability": {"margin": 0.01}, "collisions": {"margin": 0.01, "self": true, "ignore": []}})");
  for (int times = random.below(4); times > 0; --times) mutate(task, random);
  std::string text = task.dump();
  return random.below(4) ? text : damaged(text, random);
}

void checkTask(const std::string& text, const std::string&) {
  PostureSetup setup;
  if (!accepted([&] { setup = setUp(parseTask(text, "fuzz.json"), scene().scene); })) return;
  must(setup.start.allFinite(), "a start that is not finite");
}

std::string randomPosture(Random& random) {
  std::ostringstream out;
  out.precision(17);
  static const double strange[] = {std::numeric_limits<double>::quiet_NaN(),
                                   std::numeric_limits<double>::infinity(),
                                   -1e300,
                                   1e300,
                                   1e160,
                                   5e-324,
                                   1e16,
                                   -0.0};
  for (int i = 2 * scene().kinematics->size(); i > 0; --i)
    out << (random.below(12) ? random.uniform(-2, 2) : one(strange, random)) << " ";
  return out.str();
}

void checkPosture(const std::string& text, const std::string&) {
  CollisionConstraints& rows = *scene().constraints;
  Eigen::VectorXd q = Eigen::VectorXd::Zero(rows.columns()), qd = q;
  std::istringstream in(text);
  std::string word;
  for (Eigen::Index i = 0; i < 2 * q.size() && in >> word; ++i)  // also reads "nan", which streams do not
    (i < q.size() ? q[i] : qd[i - q.size()]) = std::strtod(word.c_str(), nullptr);
  RowRates rates = rows.makeRates();
  Eigen::MatrixXd jacobian(rows.rows(), rows.columns());
  Eigen::VectorXd product(rows.columns());
  const bool known = rows.evaluate(q, qd, rates, jacobian);
  const bool usable = q.allFinite() && (qd.array().abs() <= 1e100).all();
  must(known == usable, "a q or qd that cannot be used and is not told, or the other way round");
  must(!rates.d.hasNaN() && !jacobian.hasNaN(), "a distance or a derivative that is no number");
  must(!rates.speed.hasNaN() && !rates.drift.hasNaN(), "a rate that is no number");
  const Eigen::VectorXd weights = Eigen::VectorXd::Ones(rows.rows());
  rows.hessianVector(q, weights, qd, product);
  must(!product.hasNaN(), "a Hessian that is no number");
  for (int row = 0; row < rows.rows(); ++row)
    if (rows.answer(row).status == DistanceStatus::invalid)
      must(!(rates.d[row] > 0), "a row without an answer that reads as clear");
}

}  // namespace fcl_stpbv::fuzz
