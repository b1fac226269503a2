// Measures advised radii in three steps.
// 1. First runs, with r = 5 mm and R = 1 m, show how fast the bodies move.
// 2. Radii are advised for each clearance and for that motion plus a quarter.
// 3. Runs with these radii show how much acceleration the shapes add to d'' and how much clearance is lost.
//    More added acceleration than advised, in a motion within the stated limits, is an error.
#include "tools/bench/control/advice.h"

#include <algorithm>
#include <cstdio>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/volume/radii_advice.h"
#include "tools/bench/control/loop.h"

namespace fcl_stpbv::benchmark {
namespace {

// The first solid that moves: the solid that the robot holds, or its foot.
const Solid& held(const Scene& scene) {
  return *std::find_if(scene.solids.begin(), scene.solids.end(), [](const Solid& s) { return s.link >= 0; });
}

/// The largest accelerations and speeds, and the least clearance, of some runs.
Outcome worst(const std::string& scenario, const Method& method, int runs) {
  LoopOptions loop;
  loop.contacts = true;
  Outcome all;
  all.clearance = 1e9;
  for (int seed = 0; seed < runs; ++seed) {
    const Outcome one = run(makeScene(scenario, seed), method, loop);
    all.peak = std::max(all.peak, one.peak);
    all.clearance = std::min(all.clearance, one.clearance);
    all.contact.added = std::max(all.contact.added, one.contact.added);
    all.contact.speed = std::max(all.contact.speed, one.contact.speed);
    all.contact.turning = std::max(all.contact.turning, one.contact.turning);
  }
  return all;
}

}  // namespace

void measureAdvice(const std::vector<std::string>& scenarios, int runs, Measurement& result) {
  constexpr double kAllowed = 4;                                                    // m/s^2
  constexpr double kClearances[] = {0.5e-3, 1e-3, 2e-3, 4e-3, 8e-3, 16e-3, 32e-3};  // m
  // Because with other radii the robot moves slightly differently than in the first runs.
  constexpr double kSpare = 1.25;
  result.about = {{"runs", runs}};
  for (const std::string& scenario : scenarios) {
    const Scene scene = makeScene(scenario, 0);
    const bool flat =
        std::any_of(scene.solids.begin(), scene.solids.end(), [](const Solid& s) { return s.link < 0; });
    Method method{flat ? Model::half : Model::smooth, 0.005, 1, "", true};
    const ContactMotion motion = worst(scenario, method, runs).contact;
    RadiiTask task;
    task.acceleration = kAllowed;
    task.speed = kSpare * motion.speed;
    task.turning = kSpare * motion.turning;
    task.period = kTick;
    task.distance = kSecurity;
    task.bothRound = !flat;
    for (const double clearance : kClearances) {
      task.clearance = clearance;
      const RadiiAdvice advice = adviseRadii(held(scene).corners, task);
      method.r = advice.radii.r;
      method.R = advice.radii.R;
      const Outcome o = worst(scenario, method, runs);
      const bool within = o.contact.speed <= task.speed && o.contact.turning <= task.turning;
      std::printf(
          "%-6s %3g mm: at most %.3g m/s^2 (%.3g m/s, %.3g rad/s%s): r %.3g mm, R %.3g m, over-cover %.3g mm "
          "| added "
          "%.3g "
          "m/s^2, clearance lost %.3g mm, joints %.3g rad/s^2\n",
          scenario.c_str(), 1e3 * clearance, advice.acceleration, o.contact.speed, o.contact.turning,
          within ? "" : ": FASTER THAN STATED", 1e3 * method.r, method.R, 1e3 * advice.overCover,
          o.contact.added, 1e3 * (o.clearance - kSecurity), o.peak);
      std::fflush(stdout);
      if (within && o.contact.added > advice.acceleration)
        throw Error("control_bench: the shapes added " + std::to_string(o.contact.added) + " m/s^2 in " +
                    scenario + ", more than the advice allows");
      result.rows.push_back({{"scenario", scenario},
                             {"clearance", clearance},
                             {"at_most", significant(advice.acceleration, 3)},
                             {"speed", significant(task.speed, 3)},
                             {"turning", significant(task.turning, 3)},
                             {"as_stated", within},
                             {"r", significant(method.r, 3)},
                             {"R", significant(method.R, 3)},
                             {"over_cover", significant(advice.overCover, 3)},
                             {"added", significant(o.contact.added, 3)},
                             {"lost", significant(o.clearance - kSecurity, 3)},
                             {"peak", significant(o.peak, 3)}});
    }
  }
}

}  // namespace fcl_stpbv::benchmark
