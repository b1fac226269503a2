// Tests of the suite itself: the library's methods have no failures, the references are right, and each kind
// of failure is recognised.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#include "test/reference/source_folder.h"
#include "test/reference/stability/isolated.h"
#include "test/reference/stability/polyhedra.h"
#include "test/reference/stability/suite.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::stability;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

Situation boxesApart() {
  Situation s;
  s.group = "test";
  s.name = "boxes";
  s.a = s.b = makeBody(test::box(0.2, 0.2, 0.2));
  s.placements = {
      {test::pose(Matrix3d::Identity(), {0, 0, 0}), test::pose(Matrix3d::Identity(), {0.5, 0.01, 0})}};
  return s;
}

Answer distanceAnswer(double d) {
  Answer a;
  a.kind = Answer::Kind::distance;
  a.distance = d;
  a.normal[0] = 1;
  return a;
}

/// Answers each query by its template argument.
template <void (*kAct)(int query)>
class Misbehaving : public Contestant {
 public:
  static std::unique_ptr<Contestant> make(const Situation&) { return std::make_unique<Misbehaving>(); }
  Answer query(const Placement&) override {
    kAct(count_++);
    return distanceAnswer(0.3);
  }

 private:
  int count_ = 0;
};

void throwing(int) { throw std::runtime_error("no"); }
void aborting(int query) {
  if (query == 1) std::abort();
}
void hanging(int query) {
  volatile bool forever = query == 1;
  while (forever) {
  }
}

Verdict verdictOf(const Answer& answer) {
  const Situation s = boxesApart();
  const Method method{"m", "m", false, true, nullptr};
  return judge(method, s, truthsOf(s), {answer}).verdict;
}

}  // namespace

TEST_CASE("Queries on STP-BVs fail on none of the hard cases") {
  const int seed = GENERATE(1, 2, 3);
  const Results results = runSuite(
      allSituations(static_cast<std::uint64_t>(seed), test::sourceFolder() + "/data/hard_cases", false),
      {"stpbv_fcl", "stpbv_warm"});
  REQUIRE(results.methods.size() == 2);
  REQUIRE(results.situations.size() > 400);
  for (std::size_t m = 0; m < 2; ++m)
    for (std::size_t i = 0; i < results.situations.size(); ++i) {
      const Judgement& j = results.of[m][i];
      CAPTURE(results.methods[m].id, results.situations[i].group, results.situations[i].name, j.text(),
              j.amount, j.placement);
      CHECK(!isFailure(j.verdict));
    }
}

TEST_CASE("The published cases are there, each with what its report says") {
  std::vector<Situation> reports;
  addReports(reports, test::sourceFolder() + "/data/hard_cases");
  int cited = 0;
  for (const Situation& s : reports) cited += s.group == "published reports" && !s.source.empty();
  CHECK(cited >= 20);
}

TEST_CASE("The reference distance of polyhedra is that of boxes and points in closed form") {
  test::Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Isometry3d pose = test::pose(random.rotation(), random.direction());
    // A point next to a box, nearest to a face, an edge or a corner.
    const Vector3d half(0.1, 0.2, 0.15),
        out(random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), random.uniform(0.2, 0.4));
    const Vector3d beyond = (out.cwiseAbs() - half).cwiseMax(0);
    const auto box = placedCorners(test::box(0.2, 0.4, 0.3), pose, Vector3d::Zero());
    const auto point = placedCorners({out}, pose, Vector3d::Zero());
    const Nearest nearest = nearestDifference(box, point);
    CHECK(!nearest.overlap);
    CHECK(nearest.proven);
    CHECK(std::abs(static_cast<double>(nearest.difference.norm()) - beyond.norm()) < 1e-15);
  }
}

TEST_CASE("The reference overlap of boxes is that of separating axes") {
  const auto box =
      placedCorners(test::box(1, 1, 1), test::pose(Matrix3d::Identity(), {0, 0, 0}), Vector3d::Zero());
  for (const double x : {0.0, 0.3, 0.999}) {
    const auto other =
        placedCorners(test::box(1, 2, 3), test::pose(Matrix3d::Identity(), {x, 0, 0}), Vector3d::Zero());
    CHECK(nearestDifference(box, other).overlap);
    CHECK(std::abs(static_cast<double>(*leastOverlap(box, other)) - (1 - x)) < 1e-17);
  }
}

TEST_CASE("The reference of smooth bodies agrees with spheres in closed form, apart and deep in each other") {
  Situation s = boxesApart();
  s.a = s.b = makeBody({Vector3d(0, 0, 0)}, {0.1, 5});
  for (const double x : {0.5, 0.2, 0.1999, 0.05}) {
    s.placements[0].b.translation() = Vector3d(0, x, 0);
    const SmoothTruth truth = smoothTruth(s, s.placements[0]);
    REQUIRE(truth.known);
    CHECK(std::abs(static_cast<double>(truth.distance) - (x - 0.2)) < 1e-16);
  }
}

TEST_CASE("Answers get the verdict they deserve") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(verdictOf(distanceAnswer(0.3)) == Verdict::exact);
  CHECK(verdictOf(distanceAnswer(0.3 + 1e-8)) == Verdict::tolerance);
  CHECK(verdictOf(distanceAnswer(0.31)) == Verdict::wrong);
  CHECK(verdictOf(distanceAnswer(nan)) == Verdict::nan);
  Answer answer;
  answer.kind = Answer::Kind::refusal;
  CHECK(verdictOf(answer) == Verdict::none);
  answer.kind = Answer::Kind::overlap;
  CHECK(verdictOf(answer) == Verdict::wrong);
  answer.kind = Answer::Kind::apart;
  CHECK(verdictOf(answer) == Verdict::exact);
}

TEST_CASE(
    "A method that throws, ends its process or does not come back is told apart and stops no other case") {
  std::vector<Situation> situations{boxesApart(), boxesApart()};
  for (Situation& s : situations) s.placements.resize(3, s.placements[0]);
  const auto kinds = [&](std::unique_ptr<Contestant> (*make)(const Situation&)) {
    const auto answers = answersOf({"m", "m", false, true, make}, situations, 0.2);
    REQUIRE(answers.size() == 2);
    CHECK(answers[0][1].kind == answers[1][1].kind);
    return answers[1][1].kind;
  };
  CHECK(kinds(Misbehaving<throwing>::make) == Answer::Kind::exception);
  CHECK(kinds(Misbehaving<aborting>::make) == Answer::Kind::abort);
  CHECK(kinds(Misbehaving<hanging>::make) == Answer::Kind::hang);
}

TEST_CASE("A gradient that jumps between two right distances is found") {
  Situation s = boxesApart();
  s.isPath = true;
  s.placements.push_back(s.placements[0]);
  s.placements[1].b.translation().y() += 1e-9;
  std::vector<Answer> answers(2, distanceAnswer(0.3));
  for (Answer& a : answers) a.hasPoints = true, a.point[0][0] = 0.1, a.point[1][0] = 0.4;
  const Method method{"m", "m", false, true, nullptr};
  CHECK(judge(method, s, truthsOf(s), answers).verdict == Verdict::exact);
  for (auto& p : answers[1].point) p[1] += 0.05;  // the witness points jump to another corner
  CHECK(judge(method, s, truthsOf(s), answers).verdict == Verdict::jump);
}
