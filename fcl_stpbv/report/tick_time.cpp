// Steps all joints a little and times each evaluation. On a busy machine the median tells more than the mean.
#include "fcl_stpbv/report/tick_time.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::report {

using namespace detail;

std::vector<CheckedPair> closestBodies(const CollisionReport& report) {
  const int count = static_cast<int>(report.geometry->bodies.size());
  std::vector<CheckedPair> bodies;
  for (const PairReport& pair : report.pairs) {
    if (!pair.checked) continue;
    const bool obstacle = pair.body2 >= count;
    bodies.push_back({pair.body1, pair.body2 - (obstacle ? count : 0), obstacle});
  }
  return bodies;
}

RowCost tickCost(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> geometry,
                 const std::vector<CheckedPair>& rows, const ConstraintOptions& options, Eigen::VectorXd q) {
  constexpr int kTicks = 100;
  constexpr double kStep = 1e-3;  // rad or m
  CollisionConstraints constraints(std::move(kinematics), std::move(geometry), rows, options);
  Eigen::VectorXd d(constraints.rows()), values(constraints.nonZeros());
  std::vector<double> times;
  for (int i = 0; i < kTicks; ++i) {
    for (Eigen::Index k = 0; k < q.size(); ++k) q[k] += kStep * std::sin(static_cast<double>(i * (k + 1)));
    const auto start = std::chrono::steady_clock::now();
    constraints.evaluateValues(q, d, values);
    times.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::nth_element(times.begin(), times.begin() + kTicks / 2, times.end());
  RowCost cost{constraints.rows(), 0, times[kTicks / 2] * 1e6};
  const std::vector<int>& start = constraints.rowStart();
  for (int row = 0; row < constraints.rows(); ++row)
    cost.live += !values.segment(start[at(row)], start[at(row + 1)] - start[at(row)]).isZero(0);
  return cost;
}

}  // namespace fcl_stpbv::report
