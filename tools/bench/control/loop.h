// A controller at 1 kHz that follows a scene's path and avoids near bodies, and the results of its runs.
#pragma once

#include "tools/bench/control/contacts.h"

namespace fcl_stpbv::benchmark {

struct LoopOptions {
  bool noise = false;         ///< whether encoders, delay and model have errors as below
  bool acceleration = false;  ///< whether tasks ask for accelerations; otherwise for velocities
  bool contacts = false;      ///< whether to measure what shapes add to d''; slower
  double duration = 6;        ///< s
};

/// The errors with `noise`: encoders of 16 bits per turn that are read one tick late, and joints that move by
/// up to 1 % more or less than their commands.
constexpr double kEncoderStep = 2 * M_PI / 65536, kModelError = 0.01;
constexpr double kTick = 1e-3;
/// For every damper: the distance at which it begins, the distance that it keeps, and the speed in between
/// (m, m/s).
constexpr double kInfluence = 0.05, kSecurity = 0.01, kDamping = 0.5;

/// Results after the approach, computed from the joints' commands. Accelerations are differences of
/// velocities.
struct Outcome {
  double peak = 0;        ///< largest joint acceleration (rad/s^2)
  double rms = 0;         ///< root mean square of the joints' accelerations (rad/s^2)
  double jerk = 0;        ///< root mean square of the joints' jerks (rad/s^3)
  double reversals = 0;   ///< number per second and joint: two ticks above 1 rad/s^2 in opposite directions
  double switches = 0;    ///< number of changes of the acting collision rows per second
  double clearance = 0;   ///< least distance of the true hulls (m)
  double tracking = 0;    ///< mean distance from the path, hands added, blocked direction left out (m)
  double solve = 0;       ///< median time of rows and program together (us)
  long failed = 0;        ///< ticks without a solution
  ContactMotion contact;  ///< over the pairs within their damper's influence
};

Outcome run(const Scene& scene, const Method& method, const LoopOptions& options);

}  // namespace fcl_stpbv::benchmark
