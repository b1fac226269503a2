// The search for a first contact on scenes whose distances are functions of time.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <vector>

#include "fcl_stpbv/adapter/motion_search.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;

namespace {

/// Pairs whose distances change by at most 1 per unit of time. Covers are a share `part` of what that allows,
/// after `slack` is subtracted.
struct Functions {
  std::vector<std::function<double(double)>> distance;
  double part = 1;
  double slack = 0;
  double t = 0;

  void place(double time) { t = time; }
  bool look(int pair, double most, Cover& cover) {
    const double gap = distance[static_cast<std::size_t>(pair)](t);
    if (!(gap > 0)) return true;
    cover.before = cover.after = std::min(part * std::max(0.0, gap - slack), most);
    return false;
  }
};

MotionBracket search(Functions scene, double tolerance) {
  MotionRequest request;
  request.tolerance = tolerance;
  return MotionSearch<Functions>(scene, request).run(static_cast<int>(scene.distance.size()));
}

}  // namespace

TEST_CASE("a time too short to be cut that two covers leave between them is looked at") {
  // The first examined time, the middle, leaves 1e-13 at both ends.
  const MotionBracket found = search({{[](double) { return 0.5 - 1e-13; }}}, 1e-4);
  CHECK(found.verdict == MotionVerdict::free);
  CHECK(found.until == 1);
}

TEST_CASE("a contact is that of its pair, whatever was looked at since it was seen") {
  // The second pair meets at 0.5, which the search examines first. Then the first pair comes within 1e-9 at
  // 0.13, for which the search must examine ends of intervals.
  const MotionBracket found =
      search({{[](double t) { return 1e-9 + 0.9 * std::abs(t - 0.13); },
               [](double t) { return t == 0.5 ? 0.0 : 0.5 * std::abs(t - 0.5) + 0.1; }}},
             0.3);
  CHECK(found.verdict == MotionVerdict::contact);
  CHECK(found.pair == 1);
  CHECK(found.until == 0.5);
  CHECK((found.from >= 0.2 && found.from < 0.5));
}

TEST_CASE("a contact that was found is kept although the covers around it exclude one") {
  const MotionBracket found = search({{[](double t) { return t == 0.5 ? 0.0 : 1.0; }}}, 1e-4);
  CHECK(found.verdict == MotionVerdict::contact);
  CHECK(found.until == 0.5);
}

TEST_CASE("a grazing pair is undecided, and free until shortly before") {
  // Covers are smaller than the distance allows, as those of bodies are because of rounding.
  const auto graze = [](double t) { return std::abs(t - 1.0 / 3); };
  const MotionBracket found = search({{[](double) { return 0.2; }, graze}, 0.99}, 1e-4);
  CHECK(found.verdict == MotionVerdict::undecided);
  CHECK(found.pair == 1);
  CHECK(std::abs(found.from - 1.0 / 3) <= 1e-12);
  CHECK(std::abs(found.until - 1.0 / 3) <= 1e-12);
}

TEST_CASE("a contact just after a time at which rounding may hide it is one, and bracketed") {
  // At 0.5, which the search examines first, the pair is apart by less than the allowance for rounding.
  for (const double tolerance : {1e-11, 1e-6, 1e-4, 0.3}) {
    CAPTURE(tolerance);
    const double truth = 0.5 + 1e-13;
    const MotionBracket found = search({{[&](double t) { return truth - t; }}, 1, 1e-12}, tolerance);
    CHECK(found.verdict == MotionVerdict::contact);
    CHECK((found.from <= truth && found.until >= truth));
    CHECK(found.until - found.from <= tolerance);
  }
}

TEST_CASE("a contact is bracketed to 1e-12 for any smaller tolerance") {
  for (const double tolerance : {1e-12, 1e-15, 0.0, -1.0, std::nan("")}) {
    CAPTURE(tolerance);
    const MotionBracket found = search({{[](double t) { return 0.7 - t; }}, 0.99}, tolerance);
    CHECK(found.verdict == MotionVerdict::contact);
    CHECK(found.until - found.from <= 1e-12);
    CHECK(std::abs(found.until - 0.7) <= 1e-12);
  }
}

TEST_CASE("many pairs may take more looks than few") {
  // With this distance, the search must examine some hundreds of times.
  const std::function<double(double)> slow = [](double) { return 1.0 / 400; };
  MotionRequest request;
  request.mostQueries = 10;
  Functions many{std::vector(50, slow)};
  const MotionBracket free = MotionSearch<Functions>(many, request).run(50);
  CHECK(free.verdict == MotionVerdict::free);
  CHECK_FALSE(free.tooMany);
  CHECK(free.queries > 50 * 100);
  Functions slower{{[](double) { return 1e-5; }}};
  const MotionBracket given = MotionSearch<Functions>(slower, request).run(1);
  CHECK(given.verdict == MotionVerdict::undecided);
  CHECK(given.tooMany);
  CHECK(given.queries < 2000);
}
