// The table of targets, and the function that damages a text. This file has the targets for clouds, queries,
// files of volumes and of points, URDF, SRDF and meshes. An Error is accepted. Otherwise volumes must contain
// their points, and answers must keep their bounds. structured.cpp has the targets with a valid form.
#include "test/fuzz/target.h"

#include <cmath>
#include <cstdint>
#include <fstream>
#include <sstream>

#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "fcl_stpbv/robot/robot_model.h"
#include "fcl_stpbv/robot/srdf.h"
#include "test/fuzz/clouds.h"
#include "test/fuzz/property.h"
#include "test/fuzz/structured.h"
#include "test/robot/urdf_texts.h"

namespace fcl_stpbv::fuzz {

using detail::formatted;
using Eigen::Vector3d;
using test::Cloud;
using test::Random;

namespace {

std::string lineOf(const char* word, const Vector3d& p) {
  return formatted("%s %.17g %.17g %.17g\n", word, p.x(), p.y(), p.z());
}

std::string textOf(const CloudCase& c) {
  std::string text = formatted("%.17g %.17g\n", c.radii.r, c.radii.R);
  for (const Vector3d& p : c.points) text += lineOf("v", p);
  return text;
}

std::string randomCloud(Random& random) { return textOf(nastyCloud(random)); }

/// The numbers in a text, up to the first invalid word.
CloudCase cloudOf(std::istream& in) {
  CloudCase c;
  in >> c.radii.r >> c.radii.R;
  std::string word;
  for (Vector3d p; in >> word >> p[0] >> p[1] >> p[2] && word == "v";) c.points.push_back(p);
  in.clear();
  return c;
}

void checkBuild(const std::string& text, const std::string&) {
  std::istringstream in(text);
  const CloudCase c = cloudOf(in);
  StpBv::Ptr volume;
  if (!accepted([&] { volume = StpBv::build(c.points, c.radii); })) return;
  // The volume contains every point with the margin around it, so no direction's supporting plane cuts a
  // point off.
  double size = volume->enclosingRadius();
  for (const Vector3d& p : c.points) size = std::max(size, p.norm());
  const double rounding = 1e-12 * size + 1e-14 * c.radii.R;
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Vector3d n = random.direction();
    const double h = volume->support(n);
    must(std::isfinite(h), "a support value that is no number");
    for (const Vector3d& p : c.points) must(n.dot(p) + c.radii.r <= h + rounding, "a point sticks out");
  }
}

std::string randomQuery(Random& random) {
  std::string text;
  double reach = 0;
  for (int body = 0; body < 2; ++body) {
    const CloudCase c = nastyCloud(random);
    text += textOf(c) + "end\n";
    for (const Vector3d& p : c.points) reach = std::max(reach, p.norm());
  }
  for (int body = 0; body < 2; ++body) {
    Eigen::Isometry3d pose =
        test::pose(random.rotation(), reach * std::pow(10.0, random.uniform(-2, 1)) * random.direction());
    if (random.below(4) == 0) pose.linear().setIdentity();
    if (random.below(20) == 0) pose.linear()(1, 1) = random.below(2) ? std::nan("") : 1e200;
    for (int i = 0; i < 12; ++i) text += formatted("%.17g ", pose.matrix()(i / 4, i % 4));
    text += "\n";
  }
  return text;
}

void checkQuery(const std::string& text, const std::string&) {
  std::istringstream in(text);
  StpBv::Ptr body[2];
  for (auto& b : body) {
    const CloudCase c = cloudOf(in);
    if (!accepted([&] { b = StpBv::build(c.points, c.radii); })) return;
  }
  Eigen::Isometry3d pose[2] = {Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity()};
  for (Eigen::Isometry3d& p : pose)
    for (int i = 0; i < 12; ++i)
      for (std::string word; in >> word;) {  // also reads "nan", which streams do not
        p.matrix()(i / 4, i % 4) = std::strtod(word.c_str(), nullptr);
        break;
      }
  PairCache cache;
  for (int again = 0; again < 2; ++again) {
    const Distance d = distance(*body[0], pose[0], *body[1], pose[1], &cache);
    must(std::isfinite(d.distance) && d.normal.allFinite(), "an answer that is no number");
    if (d.status == DistanceStatus::invalid) return;
    must(d.point[0].allFinite() && d.point[1].allFinite(), "a witness point that is no number");
    must(std::abs(d.normal.norm() - 1) < 1e-12, "a normal that is not unit");
    const double size = body[0]->enclosingRadius() + body[1]->enclosingRadius() +
                        (pose[1].translation() - pose[0].translation()).norm() + body[0]->centre().norm() +
                        body[1]->centre().norm();
    const double rounding = 1e-12 * size + 1e-14 * (body[0]->radii().R + body[1]->radii().R);
    must(d.lower <= d.upper + rounding, "bounds the wrong way round");
    must(d.distance >= d.lower - rounding && d.distance <= d.upper + rounding,
         "a distance outside its bounds");
    must(d.status != DistanceStatus::bounded, "a query that did not converge");
  }
}

/// A small volume as a file, which is damaged in most cases.
template <void (*kSave)(std::ostream&, const StpBv&)>
std::string randomFile(Random& random) {
  for (;;) try {
      const CloudCase c = nastyCloud(random);
      std::ostringstream out;
      kSave(out, *StpBv::build(c.points, c.radii));
      return random.below(10) ? damaged(out.str(), random) : out.str();
    } catch (const Error&) {  // not every cloud makes a volume or fits a format
    }
}

template <StpBv::Ptr (*kLoad)(std::istream&, const std::string&)>
void checkFile(const std::string& text, const std::string&) {
  std::istringstream in(text);
  StpBv::Ptr volume;
  if (accepted([&] { volume = kLoad(in, "fuzz"); }))
    must(std::isfinite(volume->support(Vector3d::UnitX())), "a loaded volume without support");
}

std::string randomQhull(Random& random) {
  const Cloud cloud = nastyCloud(random).points;
  std::string text = "3\n" + std::to_string(cloud.size()) + " 1 1\n";
  for (const Vector3d& p : cloud) text += formatted("%.17g %.17g %.17g\n", p.x(), p.y(), p.z());
  return damaged(text + "3 0 1 2\n", random);
}

void checkQhull(const std::string& text, const std::string&) {
  accepted([&] { parseQhullPoints(text, "fuzz"); });
}

std::string urdf() {
  using namespace test;
  return robot(link("base", "<box size=\"0.1 0.2 0.3\"/>") +
               link("arm", "<cylinder radius=\"0.1\" length=\"0.5\"/>") +
               link("hand", "<sphere radius=\"0.1\"/>") +
               joint("shoulder", "revolute", "base", "arm",
                     "<origin xyz=\"0 0 1\" rpy=\"0 0.5 0\"/><axis xyz=\"0 1 0\"/>") +
               joint("wrist", "prismatic", "arm", "hand",
                     "<axis xyz=\"0 0 1\"/><mimic joint=\"shoulder\" multiplier=\"2\"/>"));
}

std::string randomUrdf(Random& random) { return damaged(urdf(), random); }
void checkUrdf(const std::string& text, const std::string&) {
  accepted([&] { parseUrdf(text, "fuzz.urdf"); });
}

std::string randomSrdf(Random& random) {
  return damaged(
      "<?xml version=\"1.0\"?>\n<robot name=\"small\">\n<group name=\"g\"><chain base_link=\"base\" "
      "tip_link=\"hand\"/></group>\n"
      "<group_state name=\"home\" group=\"g\"><joint name=\"shoulder\" value=\"0.5\"/></group_state>\n"
      "<disable_collisions link1=\"base\" link2=\"arm\" reason=\"Adjacent\"/>\n</robot>\n",
      random);
}
void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}
void checkSrdf(const std::string& text, const std::string& folder) {
  static const RobotModel robot = parseUrdf(urdf(), "fuzz.urdf");
  write(folder + "/fuzz.srdf", text);
  accepted([&] { loadSrdf(folder + "/fuzz.srdf", robot); });
}

constexpr char kStl[] = "/fuzz.stl", kObj[] = "/fuzz.obj", kPly[] = "/fuzz.ply", kOff[] = "/fuzz.off",
               kDae[] = "/fuzz.dae", kGltf[] = "/fuzz.gltf";

/// One target per extension, so that the first byte may be damaged too.
std::string stl() {
  std::string text = "solid s\n";
  for (int f = 0; f < 4; ++f) {
    text += "facet normal 0 0 1\nouter loop\n";
    for (int k = 0; k < 3; ++k)
      text += "vertex " + std::to_string((f + k) & 1) + " " + std::to_string((f + k) >> 1 & 1) + " 0.5\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid s\n";
}
std::string binaryStl() {
  std::string text(80, ' ');
  const std::uint32_t count = 2;
  text.append(reinterpret_cast<const char*>(&count), 4);
  for (std::uint32_t f = 0; f < count; ++f) {
    for (int i = 0; i < 12; ++i) {
      const float x = static_cast<float>((f + 1) * static_cast<std::uint32_t>(i % 5));
      text.append(reinterpret_cast<const char*>(&x), 4);
    }
    text.append(2, '\0');
  }
  return text;
}
std::string randomStl(Random& random) { return damaged(random.below(2) ? stl() : binaryStl(), random); }
std::string randomObj(Random& random) {
  return damaged("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n", random);
}
std::string randomPly(Random& random) {
  return damaged(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 2\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 2 3\n",
      random);
}
std::string randomOff(Random& random) {
  return damaged("OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n", random);
}
std::string randomDae(Random& random) {
  return damaged(
      "<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
      "version=\"1.4.1\">\n<library_geometries><geometry id=\"g\"><mesh>\n<source id=\"p\"><float_array "
      "id=\"a\" count=\"9\">0 0 0 1 0 0 0 1 0</float_array>\n<technique_common><accessor source=\"#a\" "
      "count=\"3\" stride=\"3\">\n<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param "
      "name=\"Z\" type=\"float\"/></accessor></technique_common></source>\n<vertices id=\"v\"><input "
      "semantic=\"POSITION\" source=\"#p\"/></vertices>\n<triangles count=\"1\"><input semantic=\"VERTEX\" "
      "source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>\n"
      "<library_visual_scenes><visual_scene id=\"s\"><node><instance_geometry "
      "url=\"#g\"/></node></visual_scene></library_visual_scenes>\n<scene><instance_visual_scene "
      "url=\"#s\"/></scene></COLLADA>\n",
      random);
}
std::string randomGltf(Random& random) {
  return damaged(
      "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\n\"nodes\":[{\"mesh\":0,"
      "\"children\":[1]},{\"mesh\":0}],\n\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\n"
      "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
      "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}],\n\"bufferViews\":[{\"buffer\":0,\"byteOffset\":"
      "0,"
      "\"byteLength\":36}],\n\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":"
      "\"VEC3\"}]}\n",
      random);
}
template <const char* kName>
void checkMesh(const std::string& text, const std::string& folder) {
  const std::string path = folder + kName;
  write(path, text);
  accepted([&] { loadPoints(path); });
}

StpBv::Ptr loadStpBvStream(std::istream& in, const std::string& name) { return loadStpBv(in, name); }
StpBv::Ptr loadSchStream(std::istream& in, const std::string& name) { return loadSch(in, name); }
void saveStpBvStream(std::ostream& out, const StpBv& volume) { saveStpBv(out, volume); }
void saveSchStream(std::ostream& out, const StpBv& volume) { saveSch(out, volume); }

}  // namespace

std::string damaged(std::string text, Random& random) {
  const auto somewhere = [&] {
    return static_cast<std::size_t>(random.below(static_cast<int>(text.size()) + 1));
  };
  for (int times = 1 + random.below(3); times > 0 && !text.empty(); --times) {
    const std::size_t at = somewhere() % text.size();
    const std::size_t lineEnd = std::min(text.find('\n', at), text.size() - 1);
    switch (random.below(6)) {
      case 0:
        text.resize(at);
        break;
      case 1:
        text[at] = static_cast<char>(text[at] ^ (1 << random.below(8)));
        break;
      case 2:
        text.erase(at, lineEnd - at + 1);
        break;
      case 3: {
        const std::string line = text.substr(at, lineEnd - at + 1);
        text.insert(somewhere() % text.size(), line);
        break;
      }
      case 4: {
        const std::size_t digits = text.find_first_of("0123456789", at);
        if (digits == std::string::npos) break;
        const std::size_t end = std::min(text.find_first_not_of("0123456789.eE+-", digits), text.size());
        static const char* const numbers[] = {
            "4294967295", "-1",     "1e308",      "nan", "99999999999999999999",
            "0",          "1e-320", "2147483647", "inf", "1000000000"};
        text.replace(digits, end - digits, numbers[random.below(10)]);
        break;
      }
      default:
        text.insert(at,
                    std::string(static_cast<std::size_t>(1 + random.below(40)), random.below(2) ? '<' : '9'));
        break;
    }
  }
  return text;
}

const std::vector<Target>& targets() {
  static const std::vector<Target> all{{"build", randomCloud, checkBuild},
                                       {"query", randomQuery, checkQuery},
                                       {"stpbv", randomFile<saveStpBvStream>, checkFile<loadStpBvStream>},
                                       {"sch", randomFile<saveSchStream>, checkFile<loadSchStream>},
                                       {"qhull", randomQhull, checkQhull},
                                       {"urdf", randomUrdf, checkUrdf},
                                       {"srdf", randomSrdf, checkSrdf},
                                       {"stl", randomStl, checkMesh<kStl>},
                                       {"obj", randomObj, checkMesh<kObj>},
                                       {"ply", randomPly, checkMesh<kPly>},
                                       {"off", randomOff, checkMesh<kOff>},
                                       {"dae", randomDae, checkMesh<kDae>},
                                       {"gltf", randomGltf, checkMesh<kGltf>},
                                       {"robot", randomRobot, checkRobot},
                                       {"volume", randomVolume, checkVolume},
                                       {"task", randomTask, checkTask},
                                       {"posture", randomPosture, checkPosture}};
  return all;
}

}  // namespace fcl_stpbv::fuzz
