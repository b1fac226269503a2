// Times the methods:
// 1. Make a block of new poses.
// 2. Each method answers all of them. The order of the methods is reversed from block to block. The thread's
//    processor time counts.
// 3. If single queries are timed, the time of reading the clock is measured first and subtracted.
// The first block is not counted.
#include "tools/bench/timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "tools/bench/measurement.h"

namespace fcl_stpbv::benchmark {

namespace {

using Clock = std::chrono::steady_clock;

double nanoseconds(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double, std::nano>(to - from).count();
}

/// Time of reading the clock.
double clockTime() {
  std::vector<double> times(2001);
  for (double& t : times) {
    const Clock::time_point start = Clock::now();
    t = nanoseconds(start, Clock::now());
  }
  return median(times);
}

void runBlock(Method& method, const Poses& poses, std::vector<Answer>& answers, double clock, Times* times,
              bool everyQuery) {
  const std::size_t n = poses.a.size();
  const double start = threadTime();
  if (!everyQuery) {
    for (std::size_t i = 0; i < n; ++i) method.query(poses.a[i], poses.b[i], answers[i]);
  } else {
    for (std::size_t i = 0; i < n; ++i) {
      const Clock::time_point before = Clock::now();
      method.query(poses.a[i], poses.b[i], answers[i]);
      const double t = nanoseconds(before, Clock::now()) - clock;
      if (times) times->query.push_back(std::max(0.0, t));
    }
  }
  if (times)
    times->block.push_back((threadTime() - start) / static_cast<double>(n) - (everyQuery ? 2 * clock : 0));
}

}  // namespace

double spread(std::vector<double> values) {
  const double low = percentile(values, 0.25), middle = percentile(values, 0.5);
  return 0.5 * (percentile(values, 0.75) - low) / middle;
}

std::vector<Times> timed(const std::vector<MethodPtr>& methods, GeodesicMotion& motion, int blocks,
                         int length, bool everyQuery, const Watch& watch, double seconds) {
  std::vector<Times> times(methods.size());
  std::vector<Answer> answers(static_cast<std::size_t>(length));
  Poses poses;
  std::vector<double> spent(methods.size(), 0);  // s
  const double clock = everyQuery ? clockTime() : 0;
  for (int block = -1; block < blocks; ++block) {
    motion.next(poses, length);
    for (std::size_t k = 0; k < methods.size(); ++k) {
      const std::size_t m = block % 2 ? methods.size() - 1 - k : k;
      if (spent[m] > seconds) continue;
      const double start = threadTime();
      runBlock(*methods[m], poses, answers, clock, block < 0 ? nullptr : &times[m], everyQuery);
      spent[m] += 1e-9 * (threadTime() - start);
      if (watch && block >= 0) watch(m, poses, answers);
    }
  }
  return times;
}

}  // namespace fcl_stpbv::benchmark
