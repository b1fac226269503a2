// Work on robots in pieces for parallel runs. The result of each call depends only on its arguments, to the
// last bit, never on earlier calls.
#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bodies.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/number_check.h"
#include "fcl_stpbv/robot/adjacency.h"
#include "fcl_stpbv/robot/package_path.h"
#include "fcl_stpbv/robot/pair_list.h"
#include "fcl_stpbv/robot/pair_proof.h"
#include "fcl_stpbv/robot/pair_samples.h"
#include "fcl_stpbv/robot/pair_search.h"
#include "fcl_stpbv/robot/search_room.h"
#include "interrupt.h"
#include "loading.h"
#include "made.h"
#include "parts.h"

namespace py = pybind11;

namespace fcl_stpbv {
namespace {

using namespace detail;

using Boxes = std::vector<std::pair<Eigen::VectorXd, Eigen::VectorXd>>;  ///< lower and upper limits
using GivenBoxes = std::vector<std::pair<Floats<Eigen::VectorXd>, Floats<Eigen::VectorXd>>>;

// Boxes of coordinates from Python. A box whose lower limit is above the upper one, or whose limits are not
// numbers, is refused.
std::vector<JointBox> boxesOf(const GivenBoxes& given) {
  std::vector<JointBox> boxes;
  for (const auto& [lower, upper] : given) {
    if (lower.value.size() != upper.value.size())
      throw Error("boxes: a box has " + std::to_string(lower.value.size()) + " lower limits and " +
                  std::to_string(upper.value.size()) + " upper ones; give as many of both");
    if (!(lower.value.array() <= upper.value.array()).all())
      throw Error("boxes: a lower limit is above its upper limit or not a number");
    boxes.push_back({lower.value, upper.value});
  }
  return boxes;
}

/// A robot and the pairs of its links that joints move relative to each other.
class PythonPairSearch {
 public:
  PythonPairSearch(const Path& urdf, const std::optional<Path>& obstacles, const BodyOptions::Length& r,
                   const std::optional<BodyOptions::Length>& R, const Folders& packagePath, double margin) {
    requireNumber("margin", margin, -1e6, 1e6);
    named(obstacles, "obstacles");
    GeometryOptions options = BodyOptions{r, R}.ofRobot(obstacles.has_value());
    options.packagePath = packagePath.existing();
    const auto model = std::make_shared<const RobotModel>(loading_.robot(urdf));
    const auto geometry = std::make_shared<const RobotGeometry>(loading_.geometry(*model, options));
    std::set<std::pair<int, int>> known;
    for (const CheckedPair& pair : selfPairs(*model, *geometry, nullptr)) {
      const LinkPair links = fcl_stpbv::linksOf(pair, *geometry);
      if (known.emplace(links.link1, links.link2).second) pairs_.push_back(links);
    }
    std::vector<Obstacle> around;
    if (obstacles) {
      const auto scene = std::make_shared<const RobotModel>(loading_.obstacles(*obstacles));
      around = obstaclesOf(scene, loading_.geometry(*scene, options));
      for (std::size_t link = 0; link < model->links.size(); ++link)
        for (std::size_t o = 0; o < around.size(); ++o) addObstacle(*model, *geometry, link, o);
    }
    requirePairs(pairs_.size(), *model, "all links are adjacent, rigidly joined or without a body");
    scene_ = proofScene(std::make_shared<const Kinematics>(model), geometry, std::move(around), margin);
    warn(warnings());
  }

  const std::vector<std::string>& warnings() const { return loading_.warnings; }

  std::vector<std::pair<std::string, std::string>> pairs() const {
    const std::vector<LinkModel>& links = scene_.kinematics->robot().links;
    std::vector<std::pair<std::string, std::string>> names;
    for (const LinkPair& pair : pairs_)
      names.emplace_back(links[static_cast<std::size_t>(pair.link1)].name,
                         pair.obstacle
                             ? "obstacle " + scene_.obstacles[static_cast<std::size_t>(pair.link2)].name
                             : links[static_cast<std::size_t>(pair.link2)].name);
    return names;
  }
  std::size_t linkPairs() const {
    return static_cast<std::size_t>(
        std::count_if(pairs_.begin(), pairs_.end(), [](const LinkPair& pair) { return !pair.obstacle; }));
  }
  const Kinematics& kinematics() const { return *scene_.kinematics; }
  py::str described() const {
    return decoded("<PairSearch " + kinematics().robot().name + ": " +
                   counted(static_cast<std::size_t>(kinematics().size()), "coordinate") + ", " +
                   counted(pairs_.size(), "pair") + ">");
  }

  PairProof start(std::size_t pair) const { return unproven(scene_, linksOf(pair)); }

  PairProof prove(std::size_t pair, const GivenBoxes& boxes, long most) const {
    const LinkPair links = linksOf(pair);
    requireCount(most, 0, "max_boxes");
    const std::size_t size = proofCoordinates(scene_, links).size();
    std::vector<JointBox> open = boxesOf(boxes);
    for (const JointBox& box : open)
      if (static_cast<std::size_t>(box.lower.size()) != size)
        throw Error("boxes: a box of this pair has " + std::to_string(size) + " coordinates, got one of " +
                    std::to_string(box.lower.size()));
    // Boxes, which take about 10 ms; the result of a box depends only on that box.
    constexpr long kAtOnce = 500;
    Interrupt interrupt;
    for (PairProof proof{std::move(open), std::nullopt, 0};; interrupt()) {
      const long before = proof.boxes, asked = std::min(kAtOnce, most - before);
      proof = provePair(scene_, links, std::move(proof.open), asked);
      // Ends if no box is left, the limit is reached, or no box could be cut.
      const bool ended = proof.open.empty() || before + asked >= most || proof.boxes < asked;
      proof.boxes += before;
      if (ended) return proof;
    }
  }

  std::optional<Eigen::VectorXd> descend(std::size_t pair, std::uint64_t seed, int starts) const {
    const LinkPair links = linksOf(pair);
    requireCount(starts, 0, "starts");
    PairSearch search(scene_.kinematics, scene_.geometry, links, scene_.obstacles);
    std::mt19937_64 random = numbered(seed, pair);
    Interrupt interrupt;
    for (int i = 0; i < starts; ++i, interrupt()) {
      Eigen::VectorXd q = randomConfiguration(*scene_.kinematics, search.room(), random);
      search.forget();
      if (search.descend(q, scene_.margin) <= scene_.margin) return q;
    }
    return std::nullopt;
  }

  std::vector<PairSamples> sample(std::uint64_t seed, std::uint64_t block, int count) const {
    PairSampler sampler(scene_.kinematics, scene_.geometry, pairs_, scene_.obstacles, 1);
    Interrupt interrupt;
    return sampler.sample(count, numbered(seed, block)(), scene_.margin, 1, [&](int) { interrupt(); });
  }

  std::string srdf(const std::vector<std::size_t>& never, const std::optional<Path>& path,
                   const std::vector<std::string>& comments) const {
    const RobotModel& robot = scene_.kinematics->robot();
    const std::string base = named(path, "srdf") ? path->string() : "";
    const Srdf known = base.empty() ? Srdf() : loadSrdf(base, robot);
    std::vector<PairEntry> list = joined();
    for (const std::size_t pair : std::set(never.begin(), never.end())) {
      const LinkPair& links = linksOf(pair);
      if (links.obstacle) continue;
      list.push_back(entryOf(links, PairReason::neverProven));
    }
    const SkipReasons reasons(&known);
    for (PairEntry& entry : list) {
      const auto name = [&](int link) { return robot.links[static_cast<std::size_t>(link)].name; };
      if (reasons.of(name(entry.link1), name(entry.link2)) == "User") entry.reason = PairReason::user;
    }
    return withPairs(base, robot.name, toSrdf(robot, list), comments);
  }

 private:
  void addObstacle(const RobotModel& robot, const RobotGeometry& geometry, std::size_t link, std::size_t o) {
    const LinkPair pair{static_cast<int>(link), static_cast<int>(o), true};
    if (moves(robot, pair.link1) && !bodiesOf(geometry, pair).empty()) pairs_.push_back(pair);
  }
  static PairEntry entryOf(const LinkPair& links, PairReason reason) {
    PairEntry entry{};
    static_cast<LinkPair&>(entry) = links;
    entry.reason = reason;
    return entry;
  }
  // Adjacent and rigid pairs, which are decided in one configuration.
  std::vector<PairEntry> joined() const {
    const RobotModel& robot = scene_.kinematics->robot();
    const Adjacency adjacency(robot, *scene_.geometry);
    std::vector<PairEntry> list;
    for (int b = 0; b < static_cast<int>(robot.links.size()); ++b) {
      for (int a = 0; a < b; ++a) {
        const LinkPair links{a, b};
        const Joining joining = adjacency.of(a, b);
        if (joining == Joining::separate || bodiesOf(*scene_.geometry, links).empty()) continue;
        const bool rigid = joining == Joining::rigid;
        const PairProof proof =
            rigid ? provePair(scene_, links, unproven(scene_, links).open, 1) : PairProof();
        if (!rigid) list.push_back(entryOf(links, PairReason::adjacent));
        if (rigid && proof.proven()) list.push_back(entryOf(links, PairReason::neverProven));
        if (rigid && proof.collision) list.push_back(entryOf(links, PairReason::rigid));
      }
    }
    return list;
  }
  const LinkPair& linksOf(std::size_t pair) const {
    if (pair >= pairs_.size())
      throw Error("pair: got " + std::to_string(pair) + ", the robot has " + std::to_string(pairs_.size()));
    return pairs_[pair];
  }
  // The random numbers for one piece of the work.
  static std::mt19937_64 numbered(std::uint64_t seed, std::uint64_t piece) {
    std::seed_seq mixed{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                        static_cast<std::uint32_t>(piece), static_cast<std::uint32_t>(piece >> 32)};
    return std::mt19937_64(mixed);
  }

  ProofScene scene_;
  std::vector<LinkPair> pairs_;
  Loading loading_;
};

std::vector<std::pair<std::string, std::string>> meshFiles(const Path& urdf, const Folders& packagePath) {
  const RobotModel robot = loadUrdf(urdf.string());
  const PackagePath files(urdf.string(), packagePath.existing());
  const auto none = [](const LinkModel& link) { return link.collision.empty(); };
  const bool visual = std::all_of(robot.links.begin(), robot.links.end(), none);
  std::vector<std::pair<std::string, std::string>> found;
  for (const LinkModel& link : robot.links)
    for (const ShapeModel& shape : visual ? link.visual : link.collision)
      if (shape.kind == ShapeModel::Kind::mesh) found.emplace_back(shape.mesh, files.resolve(shape.mesh));
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace
}  // namespace fcl_stpbv

template <>
struct pybind11::detail::type_caster<fcl_stpbv::PairProof> : fcl_stpbv::MadeCaster<fcl_stpbv::PairProof> {};
template <>
struct pybind11::detail::type_caster<fcl_stpbv::PythonPairSearch>
    : fcl_stpbv::MadeCaster<fcl_stpbv::PythonPairSearch> {};

namespace fcl_stpbv {
namespace {

void addProof(py::module_& module) {
  py::class_<PairProof>(module, "PairProof", "How far the proof has come that a pair of links never meets.")
      .def(py::init([](const GivenBoxes& open, const std::optional<Floats<Eigen::VectorXd>>& collision,
                       long boxes) {
             requireCount(boxes, 0, "boxes");
             PairProof proof{boxesOf(open), std::nullopt, boxes};
             if (collision && !collision->value.allFinite())
               throw Error("collision: a value is not a finite number");
             if (collision) proof.collision = collision->value;
             return proof;
           }),
           py::arg("open"), py::arg("collision") = py::none(), py::arg("boxes") = 0)
      .def_property_readonly(
          "open",
          [](const PairProof& proof) {
            Boxes open;
            for (const JointBox& box : proof.open) open.emplace_back(box.lower, box.upper);
            return open;
          },
          "Boxes not examined yet: lower and upper limits (rad or m).")
      .def_readonly("collision", &PairProof::collision,
                    "A configuration in which the pair collides, or None.")
      .def_readonly("boxes", &PairProof::boxes, "looked at by this piece, or by all pieces that were merged")
      .def_property_readonly("proven", &PairProof::proven)
      .def("merge", &merge, py::arg("other"),
           "What two pieces of one pair's proof have found together; associative and commutative.")
      .def("__repr__", [](const PairProof& proof) {
        std::string found =
            std::to_string(proof.open.size()) + (proof.open.size() == 1 ? " box open" : " boxes open");
        if (proof.proven()) found = "proven";
        if (proof.collision) found = "colliding";
        return "<PairProof: " + found + ", " + std::to_string(proof.boxes) + " looked at>";
      });
}

}  // namespace

void addShards(py::module_& module) {
  using Free = py::call_guard<py::gil_scoped_release>;
  addProof(module);
  py::class_<PythonPairSearch>(module, "PairSearch",
                               "Proofs and samples of a robot's pairs of links, in independent pieces.")
      .def(py::init<const Path&, const std::optional<Path>&, const BodyOptions::Length&,
                    const std::optional<BodyOptions::Length>&, const Folders&, double>(),
           py::arg("urdf"), py::arg("obstacles") = py::none(), py::kw_only(), py::arg("r") = 0.01,
           py::arg("R") = py::none(), py::arg("package_path") = Folders{}, py::arg("margin") = 0.0,
           "obstacles: URDF of a scene that stands still, like the robot's root link. r, R: as of Robot.\n"
           "margin: a distance not above it is a collision (m).")
      .def_property_readonly(
          "warnings", [](const PythonPairSearch& search) { return decoded(search.warnings()); },
          "What loading warned of, as Robot.warnings.")
      .def_property_readonly(
          "pairs", &PythonPairSearch::pairs,
          "Names of the links of each pair, but for adjacent and rigidly joined ones; then each moving link\n"
          "and 'obstacle NAME'.")
      .def_property_readonly("link_pairs", &PythonPairSearch::linkPairs,
                             "How many of the pairs are of two links; they come first.")
      .def_property_readonly(
          "names", [](const PythonPairSearch& search) { return search.kinematics().names(); },
          "of the coordinates")
      .def("__repr__", &PythonPairSearch::described)
      .def("unproven", &PythonPairSearch::start, py::arg("pair"), "The proof before its first step.")
      .def("prove", &PythonPairSearch::prove, py::arg("pair"), py::arg("boxes"), py::arg("max_boxes"), Free(),
           "Looks at up to so many boxes, starting with the last of these.")
      .def("descend", &PythonPairSearch::descend, py::arg("pair"), py::arg("seed"), py::arg("starts"), Free(),
           "A configuration in collision that descents from so many random ones reach first, or None.")
      .def(
          "sample",
          [](const PythonPairSearch& search, std::uint64_t seed, std::uint64_t block, int count) {
            requireCount(count, 1, "count");
            std::vector<PairSamples> found;
            {
              const py::gil_scoped_release others;
              found = search.sample(seed, block, count);
            }
            py::list pairs;
            for (const PairSamples& pair : found)
              pairs.append(
                  py::make_tuple(pair.collisions, pair.closest.front().first, pair.closest.front().second));
            return pairs;
          },
          py::arg("seed"), py::arg("block"), py::arg("count"),
          "For each pair: collisions among so many random configurations, least distance (m), where it is.")
      .def("srdf", &PythonPairSearch::srdf, py::arg("never"), py::arg("srdf") = py::none(),
           py::arg("comments") = std::vector<std::string>{},
           "The text of an SRDF that leaves out these pairs (indices) with the reason Never, and adjacent "
           "and\n"
           "rigidly joined ones; pairs with obstacles have no place in it. It keeps all of the file `srdf` "
           "but\n"
           "pairs of other reasons than User.");
  module.def("mesh_files", &meshFiles, py::arg("urdf"), py::arg("package_path") = Folders{},
             "The meshes that a robot's bodies are made of: as the URDF names them, and their paths.");
}

}  // namespace fcl_stpbv
