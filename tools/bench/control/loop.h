// A controller at 1 kHz that follows a scene's path and keeps clear of what is near, and what came of it.
#pragma once

#include "tools/bench/control/contacts.h"

namespace fcl_stpbv::benchmark {

struct LoopOptions {
  bool noise = false;         ///< encoders, delay and model as below
  bool acceleration = false;  ///< tasks ask for accelerations, else for velocities
  bool contacts = false;      ///< measure what shapes add to d''; slower
  double duration = 6;        ///< s
};

/// What noise is: encoders of 16 bits a turn, read one tick late, and joints that move by up to 1 % more or
/// less than they are told.
constexpr double kEncoderStep = 2 * M_PI / 65536, kModelError = 0.01;
constexpr double kTick = 1e-3;
/// Of every damper: where it begins, what it keeps, and the speed between (m, m/s).
constexpr double kInfluence = 0.05, kSecurity = 0.01, kDamping = 0.5;

/// After the approach, of what the joints are told; accelerations are differences of velocities.
struct Outcome {
  double peak = 0;        ///< largest joint acceleration (rad/s^2)
  double rms = 0;         ///< of the joints' acceleration (rad/s^2)
  double jerk = 0;        ///< rms (rad/s^3)
  double reversals = 0;   ///< a second and joint: two ticks above 1 rad/s^2 in opposite directions
  double switches = 0;    ///< changes of the acting collision rows a second
  double clearance = 0;   ///< least distance of the true hulls (m)
  double tracking = 0;    ///< mean distance from the path, without the direction that is blocked (m)
  double solve = 0;       ///< median time of rows and program together (us)
  long failed = 0;        ///< ticks without a solution
  ContactMotion contact;  ///< of the pairs within their damper's influence
};

Outcome run(const Scene& scene, const Method& method, const LoopOptions& options);

}  // namespace fcl_stpbv::benchmark
