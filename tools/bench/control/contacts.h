// Measures what the bodies' shapes add to a controller's distances: the c of docs/choosing_r_and_R.md.
#pragma once

#include "tools/bench/control/scene.h"

namespace fcl_stpbv::benchmark {

/// The largest values over the pairs nearer than an influence, relative to each pair's second body.
struct ContactMotion {
  double added = 0;    ///< |c|, the acceleration that the shapes add to d'' (m/s^2)
  double speed = 0;    ///< speed across the normal (m/s)
  double turning = 0;  ///< angular speed across the normal (rad/s)
};

class ContactMeter {
 public:
  ContactMeter(const Scene& scene, const Method& method, double influence);

  /// Adds the pairs at q with velocity qd, both of all coordinates.
  void measure(const Eigen::VectorXd& q, const Eigen::VectorXd& qd);
  const ContactMotion& most() const { return most_; }

 private:
  const Scene& scene_;
  double influence_;
  std::unique_ptr<CollisionConstraints> constraints_;
  RowRates rates_;
  CollisionConstraints::SparseJacobian jacobian_;
  Kinematics::State state_;
  Kinematics::Rate rate_;
  ContactMotion most_;
};

}  // namespace fcl_stpbv::benchmark
