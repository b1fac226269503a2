// scene_models: cost and verdicts of models of a robot, from coarse volumes to eight convex parts per link,
// and of the model that modelForScene() finds (docs/parts.md).
// 1. The scene: all pairs of links, in the neutral and in random configurations.
// 2. Uniform models, coarse to fine. The pairs that the finest model shows to be clear are the scene's needs.
// 3. modelForScene() for these needs, compared with them: vertices, rows, time, excess over the meshes,
// verdicts.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <optional>
#include <random>
#include <set>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/report/tick_time.h"
#include "fcl_stpbv/robot/detail_choice.h"
#include "fcl_stpbv/robot/search_room.h"
#include "tools/bench/measurement.h"
#include "tools/bench/robot_argument.h"
#include "tools/program.h"

namespace {

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using benchmark::significant;
using Geometry = std::shared_ptr<const RobotGeometry>;

struct Arguments {
  test::TestRobot robot;
  std::vector<double> budgets{0.05, 0.02};
  int samples = 1000, threads = 1;
  double clearance = 0;
};

struct Scene {
  std::shared_ptr<const Kinematics> kinematics;
  std::vector<LinkPair> pairs;
  std::vector<Eigen::VectorXd> configurations;
};

std::vector<Eigen::VectorXd> randomConfigurations(const Kinematics& kinematics, const RobotGeometry& bodies,
                                                  int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const SearchRoom room = searchRoom(kinematics, bodies, {});
  std::vector<Eigen::VectorXd> all;
  for (int i = 0; i < count; ++i) all.push_back(randomConfiguration(kinematics, room, random));
  return all;
}

Scene makeScene(const Arguments& arguments, const std::shared_ptr<const RobotModel>& robot,
                const RobotGeometry& bodies) {
  Scene scene{std::make_shared<const Kinematics>(robot), {}, {}};
  std::optional<Srdf> srdf;
  if (!arguments.robot.srdf.empty()) srdf = loadSrdf(arguments.robot.srdf, *robot);
  std::set<LinkPair> links;
  for (const CheckedPair& pair : selfPairs(*robot, bodies, srdf ? &*srdf : nullptr))
    links.insert({bodies.bodies[at(pair.body)].link, bodies.bodies[at(pair.other)].link});
  scene.pairs.assign(links.begin(), links.end());
  scene.configurations = randomConfigurations(*scene.kinematics, bodies, arguments.samples, 1);
  scene.configurations.insert(scene.configurations.begin(), scene.kinematics->neutral());
  return scene;
}

// The rows of a model, ordered by pairs of links.
struct Rows {
  std::vector<CheckedPair> bodies;
  std::vector<Eigen::Index> end;  // end of each pair's rows
};

Rows rowsOf(const Scene& scene, const RobotGeometry& geometry) {
  Rows rows;
  for (const LinkPair& pair : scene.pairs) {
    const std::vector<CheckedPair> more = bodiesOf(geometry, pair);
    rows.bodies.insert(rows.bodies.end(), more.begin(), more.end());
    rows.end.push_back(static_cast<Eigen::Index>(rows.bodies.size()));
  }
  return rows;
}

// Whether each pair is clear in each configuration.
std::vector<char> verdicts(const Rows& rows, const std::vector<Eigen::VectorXd>& configurations,
                           CollisionConstraints& constraints, double clearance) {
  std::vector<char> clear;
  Eigen::VectorXd d(constraints.rows());
  for (const Eigen::VectorXd& q : configurations) {
    constraints.evaluate(q, d);
    Eigen::Index row = 0;
    for (const Eigen::Index end : rows.end) {
      clear.push_back(d.segment(row, end - row).minCoeff() > clearance);
      row = end;
    }
  }
  return clear;
}

// How far each body exceeds its mesh at most (m): the hull of a part or of the whole mesh, plus the volume's
// over-cover.
std::vector<double> excesses(const RobotGeometry& geometry, LinkParts& parts) {
  std::vector<double> all;
  int whole = 0;
  for (const Body& body : geometry.bodies) {
    double hull = body.excess;
    if (body.partOf < 0) {
      const std::vector<Body>& one = parts.of(whole++, 1);
      hull = one.empty() ? 0 : one[0].excess;
    }
    all.push_back(hull + body.cover.max);
  }
  return all;
}

struct Verdicts {
  std::vector<char> clear;   // for each configuration and pair
  std::vector<char> others;  // the same in configurations for which no model was made
};

Verdicts judge(const std::string& name, const Scene& scene, const Geometry& geometry, LinkParts& parts,
               const std::vector<Eigen::VectorXd>& others, double clearance, nlohmann::ordered_json& row) {
  const Rows rows = rowsOf(scene, *geometry);
  ConstraintOptions handedOver;
  handedOver.handOver = report::kHandOver;
  const auto microseconds = [&](const ConstraintOptions& options) {
    return report::tickCost(scene.kinematics, geometry, rows.bodies, options, scene.configurations.front())
        .usPerTick;
  };
  const double us = microseconds({}), usHandedOver = microseconds(handedOver);
  CollisionConstraints constraints(scene.kinematics, geometry, rows.bodies);
  const Verdicts found{verdicts(rows, scene.configurations, constraints, clearance),
                       verdicts(rows, others, constraints, clearance)};
  const std::vector<double> excess = excesses(*geometry, parts);
  double sum = 0, most = 0;
  std::set<int> used;
  for (const CheckedPair& pair : rows.bodies) {
    const double both = excess[at(pair.body)] + excess[at(pair.other)];
    sum += both;
    most = std::max(most, both);
    used.insert({pair.body, pair.other});
  }
  std::size_t vertices = 0;
  for (const int body : used)
    if (geometry->bodies[at(body)].volume) vertices += geometry->bodies[at(body)].volume->vertexCount();
  row = {{"model", name},
         {"bodies", used.size()},
         {"vertices", vertices},
         {"rows", rows.bodies.size()},
         {"us_a_tick", significant(us, 3)},
         {"us_handed_over", significant(usHandedOver, 3)},
         {"excess_mean", significant(sum / static_cast<double>(rows.bodies.size()), 3)},
         {"excess_most", significant(most, 3)}};
  return found;
}

// Number of verdicts that differ from those of the finest model, and number of pairs with such verdicts.
void compare(const Verdicts& finest, std::size_t pairs, const Verdicts& found, nlohmann::ordered_json& row) {
  int verdicts = 0, others = 0;
  std::set<std::size_t> differ;
  for (std::size_t i = 0; i < finest.clear.size(); ++i) {
    if (found.clear[i] == finest.clear[i]) continue;
    ++verdicts;
    differ.insert(i % pairs);
  }
  for (std::size_t i = 0; i < finest.others.size(); ++i) others += found.others[i] != finest.others[i];
  row["verdicts_differ"] = verdicts;
  row["pairs_differ"] = differ.size();
  row["others_differ"] = others;
}

void measure(const Arguments& arguments, benchmark::Measurement& result) {
  const auto robot = std::make_shared<const RobotModel>(loadUrdf(arguments.robot.urdf));
  GeometryOptions options;
  options.packagePath = arguments.robot.packagePath;
  options.threads = arguments.threads;
  const std::vector<Geometry> levels = loadLevels(*robot, options, arguments.budgets);
  const Scene scene = makeScene(arguments, robot, *levels.back());
  const SceneModelOptions sceneOptions{options.cacheFolder, options.threads, nullptr};
  LinkParts parts(levels.back(), options.cacheFolder);
  const std::vector<Eigen::VectorXd> others =
      randomConfigurations(*scene.kinematics, *levels.back(), arguments.samples, 2);

  std::vector<Verdicts> models;
  const auto add = [&](const std::string& name, const Geometry& geometry) {
    result.rows.emplace_back();
    models.push_back(judge(name, scene, geometry, parts, others, arguments.clearance, result.rows.back()));
    std::fprintf(stderr, "%s\n", result.rows.back().dump().c_str());
  };
  for (std::size_t i = 0; i < levels.size(); ++i)
    add(i < arguments.budgets.size()
            ? "over-cover up to " + benchmark::shown(1e3 * arguments.budgets[i]) + " mm"
            : "hulls",
        levels[i]);
  for (const int most : {2, 4, 8}) {
    DetailChoice choice(scene.kinematics, {levels.back()}, {}, sceneOptions, true);
    choice.splitAll(most);
    add("up to " + std::to_string(most) + " parts", choice.geometry());
  }
  const Verdicts finest = models.back();
  std::vector<SceneNeed> needs;
  for (std::size_t i = 0; i < finest.clear.size(); ++i)
    if (finest.clear[i] && !models.front().clear[i])
      needs.push_back({scene.pairs[i % scene.pairs.size()], scene.configurations[i / scene.pairs.size()],
                       arguments.clearance});
  const double start = benchmark::threadTime();
  const SceneModel model = modelForScene(scene.kinematics, levels, {}, needs, sceneOptions);
  const double seconds = 1e-9 * (benchmark::threadTime() - start);
  add("for the scene", model.geometry);

  std::vector<std::string> split;
  for (const Body& body : model.geometry->bodies)
    if (body.parts > 0) split.push_back(body.name + " in " + std::to_string(body.parts));
  result.about = {{"pairs", scene.pairs.size()},
                  {"configurations", scene.configurations.size()},
                  {"needs", needs.size()},
                  {"unmet", model.unmet.size()},
                  {"pairs_by_parts", model.geometry->byParts.size()},
                  {"split", split},
                  {"seconds", significant(seconds, 2)}};
  for (std::size_t i = 0; i < models.size(); ++i)
    compare(finest, scene.pairs.size(), models[i], result.rows[i]);
  std::printf("%s\n", result.about.dump().c_str());
  result.print();
}

}  // namespace

int main(int argc, char** argv) {
  tools::Program app("What models of a robot cost and show, from coarse volumes to convex parts",
                     "scene_models");
  Arguments arguments;
  benchmark::describeRobot(app, arguments.robot);
  app.option("--samples", arguments.samples, "random configurations").whole(1).shown();
  app.option("--jobs", arguments.threads, "threads that share the work").whole(1).shown();
  return benchmark::runBenchmark(app, argc, argv, "scene",
                                 [&](benchmark::Measurement& result) { measure(arguments, result); });
}
