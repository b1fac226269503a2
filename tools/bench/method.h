// The methods of computing a distance that are compared, behind one interface.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/distance/distance.h"
#include "test/reference/shapes.h"

namespace fcl_stpbv::benchmark {

/// Two bodies, each both as FCL's polyhedron and as an STP-BV.
struct Bodies {
  std::shared_ptr<const StpBvGeometry> a, b;
};

/// Two separate copies of one body, so that no method gains from shared memory.
Bodies twice(const test::Cloud& cloud, const StpBvOptions& options);
Bodies geodesicSpheres(int subdivisions);  ///< radius 0.20 m, r = 1 cm, R = 10 m

enum class Outcome { apart, overlap, failed };

/// The answer of a method. `normal` is set only by methods that have one of their own (otherwise zero). For
/// other methods the normal is the direction between the points, which users compute themselves.
struct Answer {
  Outcome outcome = Outcome::failed;
  double distance = 0;
  std::array<Eigen::Vector3d, 2> point{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, 0)};
  Eigen::Vector3d normal{0, 0, 0};
  std::array<TwistGradient, 2> gradient{TwistGradient::Zero(),
                                        TwistGradient::Zero()};  ///< where a method has one

  Eigen::Vector3d direction() const { return normal.isZero() ? (point[1] - point[0]).normalized() : normal; }
};

/// One method with its setting. Holds references to the bodies.
class Method {
 public:
  Method(std::string itsName, std::string itsSetting, bool isSmooth)
      : name(std::move(itsName)), setting(std::move(itsSetting)), smooth(isSmooth) {}
  virtual ~Method() = default;
  /// Overwrites `answer` in place, because a copy of it would be timed as a part of the query.
  virtual void query(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, Answer& answer) = 0;

  const std::string name, setting;
  const bool smooth;  ///< whether it queries the STP-BVs; otherwise the polyhedra
};

using MethodPtr = std::unique_ptr<Method>;
constexpr double kFclTolerance = 1e-6;  // FCL's default

MethodPtr fclLibccd(const Bodies& bodies, double tolerance = kFclTolerance);
MethodPtr fclIndep(const Bodies& bodies, double tolerance = kFclTolerance);
/// Polyhedra, FCL's GJK with the duality gap as stopping criterion.
MethodPtr fclGapStop(const Bodies& bodies, bool warm);
MethodPtr bulletGjk(const Bodies& bodies);        ///< null if Bullet was not found at build time
MethodPtr stpBvThroughFcl(const Bodies& bodies);  ///< each query starts from FCL's witness
MethodPtr stpBvWarm(const Bodies& bodies);        ///< each query starts from the last answer

/// One of each method, with FCL's default tolerance; without Bullet if it was not found.
std::vector<MethodPtr> peers(const Bodies& bodies);

}  // namespace fcl_stpbv::benchmark
