// Verdicts and distances of whole robots by this library, FCL and Bullet, as a planner or a controller asks
// for them. The methods take turns on the same random walks. For the table of docs/robot.md, and with --sizes
// for the chart of docs/performance.md.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <thread>

#include "fcl_stpbv/robot/batch.h"
#include "fcl_stpbv/robot/checked_pairs.h"
#include "test/reference/random_walk.h"
#include "tools/bench/measurement.h"
#include "tools/bench/robot/peer.h"
#include "tools/bench/robot/sizes.h"
#include "tools/bench/robot_argument.h"
#include "tools/program.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::benchmark;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Row = nlohmann::ordered_json;

namespace {

struct Arguments {
  test::TestRobot robot;
  int configurations = 2000, turns = 5;
  bool json = false, sizes = false;
};

/// One way to answer all configurations of a walk. The first way of each question is this library's.
struct Way {
  std::string what, way;
  std::function<long(const MatrixXd&)> run;  ///< returns the number of hits
  bool shared = false;  ///< whether it uses several threads, so that wall-clock time counts
};

/// Calls `ask` for each configuration.
template <class Ask>
std::function<long(const MatrixXd&)> each(Ask ask) {
  return [ask](const MatrixXd& all) {
    long count = 0;
    for (Eigen::Index i = 0; i < all.cols(); ++i) count += static_cast<long>(ask(all.col(i)));
    return count;
  };
}

using Q = Eigen::Ref<const VectorXd>;

class Bench {
 public:
  Bench(const Arguments& arguments, test::Problem robot) : arguments_(arguments), robot_(std::move(robot)) {
    checker_ = std::make_unique<CollisionChecker>(robot_.kinematics, robot_.geometry, robot_.pairs);
    rows_ = std::make_unique<CollisionConstraints>(robot_.kinematics, robot_.geometry, robot_.pairs);
    fcl_ = fclPeer(robot_);
    gapStop_ = gapStopPeer(robot_);
    bullet_ = bulletPeer(robot_);
  }

  /// Adds rows for all ways, or for one thread and all pairs only. They begin with the entries of `about`.
  void measure(bool all, const Row& about, Measurement& result) {
    for (const bool small : {true, false}) {
      std::vector<Way> chosen = ways();
      if (all)
        for (Way& way : batches(small ? Sequence::path : Sequence::independent))
          chosen.push_back(std::move(way));
      else
        chosen.erase(
            std::remove_if(chosen.begin(), chosen.end(),
                           [](const Way& way) { return way.what != "all pairs" && way.what != "d and J"; }),
            chosen.end());
      measureSteps(small, chosen, about, result);
    }
  }

 private:
  std::vector<Way> ways() {
    d_.resize(rows_->rows());
    values_.resize(rows_->nonZeros());
    std::vector<Way> all{
        {"all pairs", "fcl_stpbv", each([&](const Q& q) { return checker_->allHits(q).size(); })},
        {"first hit", "fcl_stpbv", each([&](const Q& q) { return checker_->collides(q); })},
        {"d and J", "fcl_stpbv",
         each([&](const Q& q) { return rows_->evaluateValues(q, d_, values_) ? 0 : 1; })},
        {"least distance", "fcl_stpbv", each([&](const Q& q) { return checker_->minDistance(q) <= 0; })}};
    const auto add = [&](Peer* peer) {
      if (!peer) return;
      all.push_back({"all pairs", peer->name, each([peer](const Q& q) { return peer->hits(q, false); })});
      all.push_back({"first hit", peer->name, each([peer](const Q& q) { return peer->hits(q, true); })});
    };
    add(fcl_.get());
    add(bullet_.get());
    const auto addDistances = [&](Peer* peer, const std::string& name) {
      if (peer) all.push_back({"d and J", name, each([peer](const Q& q) { return peer->distances(q); })});
    };
    addDistances(fcl_.get(), "fcl::distance, no J");
    addDistances(gapStop_.get(), "FCL's GJK, duality-gap stop, no J");
    addDistances(bullet_.get(), "Bullet GJK, no J");
    all.push_back({"least distance", "FCL, broadphase distance",
                   each([&](const Q& q) { return fcl_->leastDistance(q) <= 0; })});
    return all;
  }

  /// This library's batches, in one and in two threads, and FCL in two.
  std::vector<Way> batches(Sequence sequence) {
    std::vector<Way> all;
    for (const int threads : {1, 2}) {
      const std::string name = threads == 1 ? "1 thread" : "2 threads";
      const auto checks = std::make_shared<CheckerBatch>(*checker_, threads);
      const auto rows = std::make_shared<ConstraintsBatch>(*rows_, threads);
      const Eigen::Index count = rows_->rows(), entries = rows_->nonZeros();
      all.push_back({"batch, first hit", name,
                     [=](const MatrixXd& q) {
                       Eigen::Array<bool, Eigen::Dynamic, 1> hit(q.cols());
                       checks->collides(q, sequence, hit);
                       return static_cast<long>(hit.count());
                     },
                     true});
      all.push_back({"batch, d and J", name,
                     [=](const MatrixXd& q) {
                       MatrixXd d(count, q.cols()), values(entries, q.cols());
                       return rows->evaluateValues(q, sequence, d, values) ? 0L : 1L;
                     },
                     true});
    }
    all.push_back({"batch, first hit", "FCL, broadphase, 2 threads", halves(), true});
    return all;
  }

  /// FCL's first hits, half of the configurations in each of two threads that have their own managers.
  std::function<long(const MatrixXd&)> halves() {
    const std::array<std::shared_ptr<Peer>, 2> peers{fclPeer(robot_), fclPeer(robot_)};
    return [peers](const MatrixXd& q) {
      std::array<long, 2> count{0, 0};
      const auto half = [&](std::size_t k) {
        const Eigen::Index middle = q.cols() / 2, first = k ? middle : 0, last = k ? q.cols() : middle;
        for (Eigen::Index i = first; i < last; ++i) count[k] += peers[k]->hits(q.col(i), true);
      };
      std::thread other(half, 1);
      half(0);
      other.join();
      return count[0] + count[1];
    };
  }

  void measureSteps(bool small, const std::vector<Way>& all, const Row& about, Measurement& result) {
    const MatrixXd q = test::randomWalk(*robot_.kinematics, small ? test::kSmallStep : test::kRandomStep,
                                        arguments_.configurations);
    std::vector<std::vector<double>> us(all.size());
    std::vector<long> counted(all.size());
    for (int turn = 0; turn < arguments_.turns; ++turn)
      for (std::size_t k = 0; k < all.size(); ++k) {
        const double thread = threadTime();
        const auto wall = std::chrono::steady_clock::now();
        counted[k] = all[k].run(q);
        const std::chrono::duration<double, std::nano> passed = std::chrono::steady_clock::now() - wall;
        const double ns = all[k].shared ? passed.count() : threadTime() - thread;
        us[k].push_back(1e-3 * ns / static_cast<double>(q.cols()));
      }
    for (std::size_t k = 0; k < all.size(); ++k) {
      std::size_t own = 0;  // the way that it is compared with
      while (all[own].what != all[k].what) ++own;
      Row row = about;
      row["what"] = all[k].what;
      row["steps"] = small ? "small" : "random";
      row["way"] = all[k].way;
      row["us"] = significant(median(us[k]), 3);
      row.update(ratios(us[k], us[own], result.spread));
      row["hits"] = counted[k];
      result.rows.push_back(std::move(row));
    }
  }

  Arguments arguments_;
  test::Problem robot_;
  std::unique_ptr<CollisionChecker> checker_;
  std::unique_ptr<CollisionConstraints> rows_;
  std::unique_ptr<Peer> fcl_, gapStop_, bullet_;
  VectorXd d_, values_;
};

/// All ways for the whole robot, or some of them against the numbers of pairs and of vertices.
void measure(const Arguments& arguments, Measurement& result) {
  const test::Problem robot = test::smoothProblem(arguments.robot);
  result.about = {{"robot", robot.model->name},
                  {"pairs", robot.pairs.size()},
                  {"configurations", arguments.configurations},
                  {"turns", arguments.turns}};
  if (!arguments.sizes) {
    Bench(arguments, robot).measure(true, Row::object(), result);
    return;
  }
  const auto add = [&](const char* varied, const test::Problem& part) {
    const Row about{
        {"varied", varied}, {"pairs", part.pairs.size()}, {"vertices", std::round(meanVertices(part))}};
    Bench(arguments, part).measure(false, about, result);
  };
  constexpr std::size_t kPairs = 130;
  for (const std::size_t pairs : {std::size_t{8}, std::size_t{32}, kPairs, std::size_t{561}})
    if (pairs <= robot.pairs.size()) add("pairs", withPairs(robot, pairs));
  for (int subdivisions = 0; subdivisions <= 3; ++subdivisions)
    add("vertices", withEllipsoids(withPairs(robot, std::min(kPairs, robot.pairs.size())), subdivisions));
}

void printAsOne(const Measurement& result) {
  nlohmann::ordered_json all = result.about;
  all["spread"] = significant(result.spread, 2);
  all["rows"] = result.rows;
  std::printf("%s\n", all.dump(1).c_str());
}

}  // namespace

int main(int argc, char** argv) {
  tools::Program app("A robot's verdicts, distances and batches beside FCL and Bullet, us a configuration",
                     "robot_bench");
  Arguments arguments;
  describeRobot(app, arguments.robot);
  app.option("--configurations", arguments.configurations, "of each random walk").whole(1).shown();
  app.option("--turns", arguments.turns, "of all ways").whole(1).shown();
  app.flag("--json", arguments.json, "print one JSON object instead of lines");
  app.flag("--sizes", arguments.sizes,
           "times against the number of pairs, then with ellipsoids of 12 to 642 vertices");
  return runBenchmark(app, argc, argv, "robot", [&](Measurement& result) {
    measure(arguments, result);
    arguments.json ? printAsOne(result) : result.print();
  });
}
