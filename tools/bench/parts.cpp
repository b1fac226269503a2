// parts_benchmark: convex parts compared with the hulls of HACD's partition (docs/parts.md).
// 1. Their largest distance from the mesh, and the processor time to compute them.
// 2. For a robot: the time of a controller's tick, with the rows of all pairs of all links' parts.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/parts/convex_parts.h"
#include "fcl_stpbv/report/tick_time.h"
#include "fcl_stpbv/robot/checked_pairs.h"
#include "tools/bench/measurement.h"
#include "tools/bench/parts/hacd.h"
#include "tools/program.h"

namespace {

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using benchmark::significant;
using Clouds = std::vector<std::vector<Eigen::Vector3d>>;

constexpr double kConcave = 0.005;  // m: a link whose hull exceeds its mesh by more than this is split

double processorTime() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Arguments {
  std::vector<std::string> meshes, packagePath;
  std::vector<int> counts{2, 4, 8};
  double effort = 1;
  bool hacd = true;
  std::string robot;
};

double excessOf(const Clouds& clouds, const MeshSolid& solid) {
  double excess = 0;
  for (const auto& cloud : clouds) excess = std::max(excess, hullExcess(cloud, solid).upper);
  return excess;
}

Clouds oursOf(const TriangleMesh& mesh, int count, double effort) {
  PartsOptions options;
  options.most = count;
  options.effort = effort;
  Clouds clouds;
  for (const ConvexPart& part : convexParts(mesh, options).parts) clouds.push_back(part.points);
  return clouds;
}

// The parts of one mesh by one method. Adds a row with their quality.
Clouds split(const std::string& name, const TriangleMesh& mesh, const std::string& method, int count,
             double effort, std::vector<nlohmann::ordered_json>& rows) {
  const MeshSolid solid(mesh);
  const double start = processorTime();
  const Clouds clouds = method == "ours" ? oursOf(mesh, count, effort) : benchmark::hacdClusters(mesh, count);
  const double seconds = processorTime() - start;
  rows.push_back({{"mesh", name},
                  {"triangles", mesh.triangles.size()},
                  {"hull_excess", significant(hullExcess(mesh.vertices, solid).upper, 4)},
                  {"method", method},
                  {"most", count},
                  {"parts", clouds.size()},
                  {"excess", significant(excessOf(clouds, solid), 4)},
                  {"seconds", significant(seconds, 2)}});
  std::printf("%s\n", rows.back().dump().c_str());
  std::fflush(stdout);
  return clouds;
}

std::vector<std::string> methodsOf(const Arguments& a) {
  return a.hacd ? std::vector<std::string>{"ours", "HACD"} : std::vector<std::string>{"ours"};
}

// A robot in which given links consist of parts and the others are whole, and the rows of all pairs of links.
class Tick {
 public:
  explicit Tick(const Arguments& a) : robot_(std::make_shared<const RobotModel>(loadUrdf(a.robot))) {
    GeometryOptions options;
    options.packagePath = a.packagePath;
    whole_ = std::make_shared<const RobotGeometry>(loadGeometry(*robot_, options));
    for (const CheckedPair& pair : selfPairs(*robot_, *whole_, nullptr))
      links_.insert({whole_->bodies[at(pair.body)].link, whole_->bodies[at(pair.other)].link});
  }

  const std::vector<Body>& bodies() const { return whole_->bodies; }

  nlohmann::ordered_json cost(const std::map<std::size_t, Clouds>& parts) const {
    auto geometry = std::make_shared<RobotGeometry>();
    for (std::size_t i = 0; i < whole_->bodies.size(); ++i) {
      const auto found = parts.find(i);
      if (found == parts.end()) {
        geometry->bodies.push_back(whole_->bodies[i]);
        continue;
      }
      for (const auto& cloud : found->second) geometry->bodies.push_back(ofCloud(whole_->bodies[i], cloud));
    }
    std::vector<CheckedPair> rows;
    for (const LinkPair& pair : links_) {
      const std::vector<CheckedPair> more = bodiesOf(*geometry, pair);
      rows.insert(rows.end(), more.begin(), more.end());
    }
    const auto kinematics = std::make_shared<const Kinematics>(robot_);
    std::vector<double> us;
    for (int i = 0; i < 7; ++i)
      us.push_back(report::tickCost(kinematics, geometry, rows, {}, kinematics->neutral()).usPerTick);
    return {{"bodies", geometry->bodies.size()},
            {"rows", rows.size()},
            {"us_a_tick", significant(benchmark::median(us), 3)}};
  }

 private:
  static Body ofCloud(const Body& whole, const std::vector<Eigen::Vector3d>& cloud) {
    Body body = whole;
    body.volume = StpBv::build(cloud, {whole.volume->radii().r, whole.volume->radii().R});
    body.geometry = std::make_shared<StpBvGeometry>(body.volume);
    body.centre = body.pose * body.volume->centre();
    body.radius = body.volume->enclosingRadius();
    return body;
  }

  std::shared_ptr<const RobotModel> robot_;
  std::shared_ptr<const RobotGeometry> whole_;
  std::set<LinkPair> links_;
};

void measureRobot(const Arguments& a, benchmark::Measurement& result) {
  const Tick tick(a);
  struct Link {
    std::size_t body;
    std::string name;
    TriangleMesh mesh;
  };
  std::vector<Link> concave;
  for (std::size_t i = 0; i < tick.bodies().size(); ++i) {
    const Body& body = tick.bodies()[i];
    if (body.file.empty() || !body.volume) continue;
    TriangleMesh mesh = loadMesh(body.file, body.scale);
    if (mesh.triangles.empty() || hullExcess(mesh.vertices, MeshSolid(mesh)).upper < kConcave) continue;
    concave.push_back({i, body.name, std::move(mesh)});
  }
  nlohmann::ordered_json ticks = nlohmann::ordered_json::array();
  const auto add = [&](const std::string& method, int count, const std::map<std::size_t, Clouds>& parts) {
    nlohmann::ordered_json one = {{"method", method}, {"most", count}};
    one.update(tick.cost(parts));
    std::printf("%s\n", one.dump().c_str());
    ticks.push_back(std::move(one));
  };
  add("hulls", 1, {});
  for (const int count : a.counts)
    for (const std::string& method : methodsOf(a)) {
      std::map<std::size_t, Clouds> parts;
      for (const Link& link : concave)
        parts[link.body] = split(link.name, link.mesh, method, count, a.effort, result.rows);
      add(method, count, parts);
    }
  result.about = {{"concave_links", concave.size()}, {"concave_beyond", kConcave}, {"ticks", ticks}};
}

void measureMeshes(const Arguments& a, benchmark::Measurement& result) {
  for (const std::string& file : a.meshes) {
    const TriangleMesh mesh = loadMesh(file);
    for (const int count : a.counts)
      for (const std::string& method : methodsOf(a))
        split(std::filesystem::path(file).stem(), mesh, method, count, a.effort, result.rows);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Arguments a;
  tools::Program app(
      "Largest excess over the mesh (m) of a few convex parts, ours and HACD's, the processor's seconds for "
      "them, and what they cost a robot's controller",
      "parts_benchmark");
  tools::Option meshes = app.option("meshes", a.meshes, "mesh files").existingFile();
  app.option("--robot", a.robot, "a URDF, whose concave links are split instead")
      .existingFile()
      .excludes(meshes);
  app.option("--package-path", a.packagePath, "folder that holds packages").repeated();
  app.option("--parts", a.counts, "numbers of parts").whole(1, 1000);
  app.option("--effort", a.effort, "of the search").number(1e-3, 1e6);
  app.flag("!--no-hacd", a.hacd, "ours alone");
  return benchmark::runBenchmark(app, argc, argv, "parts", [&](benchmark::Measurement& result) {
    if (a.robot.empty() && a.meshes.empty()) throw Error("nothing to split: give mesh files, or --robot");
    a.robot.empty() ? measureMeshes(a, result) : measureRobot(a, result);
  });
}
