// Measures where continuity helps a controller: the figures of docs/control.md.
//   control_bench --runs 20 -o docs/measured
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "tools/bench/control/advice.h"
#include "tools/bench/control/loop.h"
#include "tools/bench/measurement.h"
#include "tools/program.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::benchmark;

namespace {

std::vector<Method> methods(bool all, const std::string& scenario) {
  std::vector<Method> list{{Model::none, 0, 0, "no collision rows"}, {Model::hull, 0, 0, "hull"}};
  const std::vector<double> rs = all ? std::vector<double>{0.001, 0.005, 0.01} : std::vector<double>{0.01};
  const std::vector<double> Rs = all ? std::vector<double>{1, 3, 10} : std::vector<double>{1, 10};
  for (double r : rs) list.push_back({Model::hull, r, 0, "hull + r, r " + shown(1e3 * r) + " mm"});
  if (scenario != "arms") list.push_back({Model::manifold, 0.01, 0, "manifold, r 10 mm"});
  // Whether one of the bodies is a static obstacle.
  const bool flat = scenario != "arms" && scenario != "boxes";
  for (double r : rs)
    for (double R : Rs) {
      const std::string radii = "r " + shown(1e3 * r) + " mm, R " + shown(R) + " m";
      list.push_back({Model::smooth, r, R, "STP-BV, " + radii});
      if (flat) list.push_back({Model::half, r, R, "STP-BV | flat, " + radii});
    }
  return list;
}

struct Summary {
  Outcome median, worst;
};

Summary summary(const std::vector<Outcome>& all) {
  Summary s;
  const auto of = [&](double Outcome::*value, bool low) {
    std::vector<double> list;
    for (const Outcome& o : all) list.push_back(o.*value);
    std::sort(list.begin(), list.end());
    s.median.*value = list[list.size() / 2];
    s.worst.*value = low ? list.front() : list.back();
  };
  for (double Outcome::*value : {&Outcome::peak, &Outcome::rms, &Outcome::jerk, &Outcome::reversals,
                                 &Outcome::switches, &Outcome::tracking, &Outcome::solve})
    of(value, false);
  of(&Outcome::clearance, true);
  for (const Outcome& o : all) s.worst.failed += o.failed;
  return s;
}

struct Arguments {
  int runs = 20;
  bool all = false, advise = false;
  LoopOptions loop;
  std::vector<std::string> scenarios = benchmark::scenarios();
};

void measure(const Arguments& a, Measurement& result) {
  result.about = {{"runs", a.runs}, {"acceleration", a.loop.acceleration}, {"noise", a.loop.noise}};
  std::printf("%-6s %-32s %9s %9s %8s %9s %8s %8s %9s %9s %8s %7s %5s\n", "", "medians (worst: *)", "peak",
              "peak*", "rms", "jerk", "rev/s", "switch/s", "clear mm", "clear* mm", "track mm", "us", "fail");
  for (const std::string& scenario : a.scenarios)
    for (const Method& method : methods(a.all, scenario)) {
      std::vector<Outcome> outcomes;
      for (int seed = 0; seed < a.runs; ++seed)
        outcomes.push_back(run(makeScene(scenario, seed), method, a.loop));
      const Summary s = summary(outcomes);
      const Outcome &m = s.median, &w = s.worst;
      std::printf("%-6s %-32s %9.3g %9.3g %8.3g %9.3g %8.3g %8.3g %9.4g %9.4g %8.3g %7.1f %5ld\n",
                  scenario.c_str(), method.name.c_str(), m.peak, w.peak, m.rms, m.jerk, m.reversals,
                  m.switches, 1e3 * m.clearance, 1e3 * w.clearance, 1e3 * m.tracking, m.solve, w.failed);
      std::fflush(stdout);
      result.rows.push_back({{"scenario", scenario},
                             {"method", method.name},
                             {"peak", significant(m.peak, 3)},
                             {"worst_peak", significant(w.peak, 3)},
                             {"rms", significant(m.rms, 3)},
                             {"jerk", significant(m.jerk, 3)},
                             {"reversals", significant(m.reversals, 3)},
                             {"switches", significant(m.switches, 3)},
                             {"clearance", significant(m.clearance, 3)},
                             {"worst_clearance", significant(w.clearance, 3)},
                             {"tracking", significant(m.tracking, 3)},
                             {"us", significant(m.solve, 3)},
                             {"failed", w.failed}});
    }
}

}  // namespace

int main(int argc, char** argv) {
  tools::Program app(
      "Peak accelerations of a controller whose collision rows come from hulls, manifolds and STP-BVs.",
      "control_bench");
  Arguments a;
  app.option("--runs", a.runs, "runs a row, each with its own path and start").whole(1).shown();
  app.option("--scenario", a.scenarios, "only these").oneOf(scenarios());
  app.flag("--all", a.all, "every r and R, not only r = 10 mm with R = 1 and 10 m");
  app.flag("--advise", a.advise, "radii advised for some clearances, and what runs with them measure");
  app.flag("--acceleration", a.loop.acceleration, "tasks at acceleration level");
  app.flag("--noise", a.loop.noise, "with encoder steps, a tick of delay and a model error of 1 %");
  return runBenchmark(app, argc, argv, "control", [&](Measurement& result) {
    a.advise ? measureAdvice(a.scenarios, a.runs, result) : measure(a, result);
  });
}
