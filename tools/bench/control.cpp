// Where continuity pays in a controller: the figures of docs/control.md.
//   control_bench --runs 20 -o docs/images
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "tools/bench/chart.h"
#include "tools/bench/control/loop.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::benchmark;

namespace {

std::vector<Method> methods(bool all, const std::string& scenario) {
  std::vector<Method> list{{Model::none, 0, 0, "no collision rows"}, {Model::hull, 0, 0, "hull"}};
  const std::vector<double> rs = all ? std::vector<double>{0.001, 0.005, 0.01} : std::vector<double>{0.01};
  const std::vector<double> Rs = all ? std::vector<double>{1, 3, 10} : std::vector<double>{1, 10};
  for (double r : rs) list.push_back({Model::hull, r, 0, text("hull + r, r %g mm", 1e3 * r)});
  if (scenario != "arms") list.push_back({Model::manifold, 0.01, 0, "manifold, r 10 mm"});
  const bool flat = scenario != "arms" && scenario != "boxes";  // whether a body stands still
  for (double r : rs)
    for (double R : Rs) {
      list.push_back({Model::smooth, r, R, text("STP-BV, r %g mm, R %g m", 1e3 * r, R)});
      if (flat) list.push_back({Model::half, r, R, text("STP-BV | flat, r %g mm, R %g m", 1e3 * r, R)});
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

/// Peak acceleration of the methods in every scenario, beside each other.
Chart chartOf(
    const std::vector<std::pair<std::string, std::vector<std::pair<std::string, Summary>>>>& results) {
  Chart chart;
  chart.name = "control";
  const std::vector<std::pair<std::string, std::string>> shown{{"hull + r, r 10 mm", "#d62728"},
                                                               {"manifold, r 10 mm", "#ff7f0e"},
                                                               {"STP-BV, r 10 mm, R 10 m", "#1f77b4"},
                                                               {"STP-BV, r 10 mm, R 1 m", "#17becf"}};
  chart.plot = "$peaks << EOD\n";
  for (const auto& [scenario, methods] : results) {
    chart.plot += scenario;
    for (const auto& [name, colour] : shown) {
      const auto found =
          std::find_if(methods.begin(), methods.end(), [&n = name](const auto& m) { return m.first == n; });
      chart.plot += found == methods.end() ? " NaN" : text(" %g", found->second.median.peak);
    }
    chart.plot += '\n';
  }
  chart.plot +=
      "EOD\nset style data histograms\nset style histogram clustered gap 1\nset style fill solid border -1\n"
      "set logscale y\nset yrange [0.5:*]\nset grid y\nset key top right\nset ylabel 'peak joint "
      "acceleration "
      "(rad/s^2)'\nset lmargin 9\nset tmargin 2\nplot ";
  for (std::size_t i = 0; i < shown.size(); ++i)
    chart.plot += text("%s$peaks using %zu%s lc rgb '%s' title '%s'", i ? ", " : "", i + 2,
                       i ? "" : ":xtic(1)", shown[i].second.c_str(), shown[i].first.c_str());
  chart.plot += '\n';
  return chart;
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{
      "Peak accelerations of a controller whose collision rows come from hulls, manifolds and STP-BVs."};
  int runs = 20;
  bool all = false, acceleration = false, noise = false;
  std::vector<std::string> chosen = scenarios();
  std::string output;
  app.add_option("--runs", runs, "runs a row, each with its own path and start")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--scenario", chosen, "only these")->check(CLI::IsMember(scenarios()));
  app.add_flag("--all", all, "every r and R, not only r = 10 mm with R = 1 and 10 m");
  app.add_flag("--acceleration", acceleration, "tasks at acceleration level");
  app.add_flag("--noise", noise, "with encoder steps, a tick of delay and a model error of 1 %");
  app.add_option("-o,--output", output, "folder for control.csv and control.svg");
  CLI11_PARSE(app, argc, argv);
  LoopOptions options;
  options.acceleration = acceleration;
  options.noise = noise;
  if (!output.empty()) requireGnuplot();
  std::vector<std::pair<std::string, std::vector<std::pair<std::string, Summary>>>> results;
  std::vector<std::string> rows;
  std::printf("%-6s %-32s %9s %9s %8s %9s %8s %8s %9s %9s %8s %7s %5s\n", "", "medians (worst: *)", "peak",
              "peak*", "rms", "jerk", "rev/s", "switch/s", "clear mm", "clear* mm", "track mm", "us", "fail");
  for (const std::string& scenario : chosen) {
    results.push_back({scenario, {}});
    for (const Method& method : methods(all, scenario)) {
      std::vector<Outcome> outcomes;
      for (int seed = 0; seed < runs; ++seed)
        outcomes.push_back(run(makeScene(scenario, seed), method, options));
      const Summary s = summary(outcomes);
      const Outcome &m = s.median, &w = s.worst;
      std::printf("%-6s %-32s %9.3g %9.3g %8.3g %9.3g %8.3g %8.3g %9.4g %9.4g %8.3g %7.1f %5ld\n",
                  scenario.c_str(), method.name.c_str(), m.peak, w.peak, m.rms, m.jerk, m.reversals,
                  m.switches, 1e3 * m.clearance, 1e3 * w.clearance, 1e3 * m.tracking, m.solve, w.failed);
      std::fflush(stdout);
      rows.push_back(text("%s,\"%s\",%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%ld", scenario.c_str(),
                          method.name.c_str(), m.peak, w.peak, m.rms, m.jerk, m.reversals, m.switches,
                          m.clearance, w.clearance, m.tracking, w.failed));
      results.back().second.emplace_back(method.name, s);
    }
  }
  if (output.empty()) return 0;
  Chart chart = chartOf(results);
  chart.header =
      "scenario,method,peak,worst_peak,rms,jerk,reversals,switches,clearance,worst_clearance,tracking,failed";
  chart.rows = rows;
  chart.caption =
      text("HRP-2-style robot, 1 kHz, %s level, %s noise; medians of %d runs, seeds 0 to %d; rad, m, s",
           acceleration ? "acceleration" : "velocity", noise ? "with" : "without", runs, runs - 1);
  return write(chart, output, true) ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "control_bench: %s\n", error.what());
  return 2;
}
