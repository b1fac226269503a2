// The workload "geodesic" (the paper's V.B): two geodesic spheres that turn
// while their distance goes to and fro.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace fcl_stpbv::benchmark {

/// How far the bodies move between two queries.
struct Step {
  const char* name;
  double turn;   ///< angle about each of three axes (rad)
  double shift;  ///< distance along the line of centres (m)
};

Step largeStep();  ///< 20 degrees, 2 cm
Step smallStep();  ///< 1 degree, 1 mm

struct Poses {
  std::vector<Eigen::Isometry3d> a, b;
};

/// A sequence of poses. The angles advance by incommensurable steps, so no configuration occurs twice.
class GeodesicMotion {
 public:
  /// Centres 0.38 m to 0.80 m apart; at spheres of radius 0.20 m the nearest 5 % overlap.
  static constexpr double kNearest = 0.38, kRange = 0.42;

  /// After this number of queries both steps have gone to and fro a whole number of times. So blocks of this
  /// length have the same mixture of distances.
  static constexpr int kCycle = 840;

  GeodesicMotion(const Step& step, std::uint64_t seed, double nearest = kNearest);

  /// Replaces `poses` by the next `count` ones.
  void next(Poses& poses, int count);

 private:
  Step step_;
  double nearest_;
  Eigen::Matrix3d firstA_, firstB_;
  std::uint64_t query_ = 0;
};

}  // namespace fcl_stpbv::benchmark
