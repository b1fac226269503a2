// The ways to a distance that are compared, behind one interface.
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

/// Two bodies, as FCL's polyhedra and as STP-BVs in one.
struct Bodies {
  std::shared_ptr<const StpBvGeometry> a, b;
};

/// Two separate copies of one body, so that no method gains from both being the same memory.
Bodies twice(const test::Cloud& cloud, const StpBvOptions& options);
Bodies geodesicSpheres(int subdivisions);  ///< radius 0.20 m, r = 1 cm, R = 10 m

enum class Outcome { apart, overlap, failed };

/// What a method says. `normal` only of methods that have one of their own (else zero): for the others it is
/// the direction between the points, which users compute themselves.
struct Answer {
  Outcome outcome = Outcome::failed;
  double distance = 0;
  std::array<Eigen::Vector3d, 2> point{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, 0)};
  Eigen::Vector3d normal{0, 0, 0};
  std::array<TwistGradient, 2> gradient{TwistGradient::Zero(),
                                        TwistGradient::Zero()};  ///< where a method has one

  Eigen::Vector3d direction() const { return normal.isZero() ? (point[1] - point[0]).normalized() : normal; }
};

/// One way to ask, with its setting. Holds references to the bodies.
class Method {
 public:
  Method(std::string itsName, std::string itsSetting, bool isSmooth)
      : name(std::move(itsName)), setting(std::move(itsSetting)), smooth(isSmooth) {}
  virtual ~Method() = default;
  /// Overwrites `answer`, in its place: a copy of it would be timed along with the query.
  virtual void query(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, Answer& answer) = 0;

  const std::string name, setting;
  const bool smooth;  ///< asks about the STP-BVs; else about the polyhedra
};

using MethodPtr = std::unique_ptr<Method>;
constexpr double kFclTolerance = 1e-6;  // FCL's default

MethodPtr fclLibccd(const Bodies& bodies, double tolerance = kFclTolerance);
MethodPtr fclIndep(const Bodies& bodies, double tolerance = kFclTolerance);
MethodPtr fclGapStop(const Bodies& bodies, bool warm);  ///< polyhedra, FCL's GJK with the duality gap as stop
MethodPtr bulletGjk(const Bodies& bodies);        ///< null where Bullet was not found when this was built
MethodPtr stpBvThroughFcl(const Bodies& bodies);  ///< each query starts from FCL's witness
MethodPtr stpBvWarm(const Bodies& bodies);        ///< each query starts from the last answer

/// One of each, with FCL's default tolerance; without Bullet where it was not found.
std::vector<MethodPtr> peers(const Bodies& bodies);

}  // namespace fcl_stpbv::benchmark
