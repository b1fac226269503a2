// Time against error: each method over its tolerance; those without one are single points.
#include <algorithm>
#include <cmath>
#include <map>

#include "tools/bench/charts.h"
#include "tools/bench/reference_answer.h"
#include "tools/bench/timing.h"

namespace fcl_stpbv::benchmark {

namespace {

constexpr int kBlocks = 24;
constexpr std::size_t kCheckEvery = 23;  // the reference of the STP-BVs takes milliseconds
constexpr double kWrong = 1e-6;          // m: what FCL's default tolerance promises
constexpr double kFloor = 1e-18;         // where an error of nothing is drawn

/// One method's errors, and what it missed.
struct Record {
  std::vector<double> distance, normal;
  int checked = 0, wrong = 0, missed = 0;

  void add(const Answer& answer, const Truth& truth, bool smooth) {
    ++checked;
    // Polyhedra apart are to be found apart; STP-BVs may overlap within their margins and have an answer
    // then.
    if (answer.outcome == Outcome::failed || (!smooth && answer.outcome != Outcome::apart)) {
      ++missed;
      return;
    }
    const Errors e = errorsOf(answer, truth);
    if (!std::isfinite(e.distance) || !std::isfinite(e.normal)) {
      ++missed;
      return;
    }
    wrong += e.distance > kWrong;
    distance.push_back(std::max(e.distance, kFloor));
    normal.push_back(std::max(e.normal, kFloor));
  }
};

std::vector<MethodPtr> allMethods(const Bodies& bodies) {
  std::vector<MethodPtr> methods;
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    methods.push_back(fclLibccd(bodies, tolerance));
    methods.push_back(fclIndep(bodies, tolerance));
  }
  if (MethodPtr bullet = bulletGjk(bodies)) methods.push_back(std::move(bullet));
  methods.push_back(fclGapStop(bodies, false));
  methods.push_back(fclGapStop(bodies, true));
  methods.push_back(stpBvThroughFcl(bodies));
  methods.push_back(stpBvWarm(bodies));
  return methods;
}

/// The truths of one block, each found when first asked for.
class BlockTruths {
 public:
  explicit BlockTruths(const Bodies& bodies) : bodies_(bodies) {}
  const Truth& of(const Poses& poses, std::size_t i, bool smooth) {
    if (!poses_ || poses_->a[0].matrix() != poses.a[0].matrix()) {
      truths_.clear();
      poses_ = std::make_unique<Poses>(poses);
    }
    const auto [entry, isNew] = truths_.try_emplace({i, smooth});
    if (isNew)
      entry->second = smooth ? smoothTruth(bodies_, poses.a[i], poses.b[i])
                             : polyhedralTruth(bodies_, poses.a[i], poses.b[i]);
    return entry->second;
  }

 private:
  const Bodies& bodies_;
  std::unique_ptr<Poses> poses_;
  std::map<std::pair<std::size_t, bool>, Truth> truths_;
};

/// A method's points, and over all of its settings how often it was wrong.
struct Curve {
  std::string rows;
  int checked = 0, wrong = 0, missed = 0;
};

std::string title(const std::string& method, const Curve& curve) {
  return method + text(": of %d, %d off by > 1 µm, %d missed", curve.checked, curve.wrong, curve.missed);
}

/// Both panels of one motion: curves of (error, time) with bars from the median to the worst error and from
/// p5 to p99 of the time.
std::string panels(const std::string& step, const std::map<std::string, Curve>& data) {
  std::string plot;
  int block = 0;
  for (const auto& [method, curve] : data)
    plot += text("$%s%d << EOD\n", step.c_str(), block++) + curve.rows + "EOD\n";
  for (const bool normal : {false, true}) {
    plot += text("set title '%s steps: %s' font ',12'\nset xlabel '%s'\n", step.c_str(),
                 normal ? "normal" : "distance",
                 normal ? "error of the normal (rad)" : "error of the distance (m)");
    plot += normal ? "set ylabel ''\nset key off\n"
                   : "set ylabel 'ns a query'\nset key bottom right font ',10'\n";
    std::string curves;
    block = 0;
    const int x = normal ? 4 : 1;
    for (const auto& [method, curve] : data) {
      const std::string name = text("$%s%d", step.c_str(), block++), look = style(method);
      curves += (curves.empty() ? "plot " : ", ") + name +
                text(" using %d:8:%d:%d:7:9 with xyerrorbars ", x + 1, x, x + 2) + look +
                " ps 0.01 lw 0.7 notitle, " + name + text(" using %d:8 with linespoints ", x + 1) + look +
                " ps 0.8 lw 2 title '" + title(method, curve) + "'";
    }
    plot += curves + "\n";
  }
  return plot;
}

}  // namespace

Chart solverErrorChart(const ChartOptions& options) {
  Chart chart;
  chart.name = "solver_error";
  chart.header =
      "steps,method,setting,ns_p5,ns_p50,ns_p99,distance_error_p50,distance_error_p99,distance_error_max,"
      "normal_error_p50,normal_error_p99,normal_error_max,queries,checked,off_by_more_than_1e-6,missed,"
      "spread";
  chart.width = 1000;
  chart.height = 860;
  const Bodies bodies = geodesicSpheres(2);
  std::string plot =
      "set multiplot layout 2,2 margins 0.075,0.985,0.125,0.96 spacing 0.08,0.125\nset logscale xy\n"
      "set format '10^{%L}'\nset xrange [1e-18:1]\nset yrange [20:200000]\n";
  for (const Step& step : {smallStep(), largeStep()}) {
    const std::vector<MethodPtr> methods = allMethods(bodies);
    std::vector<Record> records(methods.size());
    BlockTruths truths(bodies);
    GeodesicMotion motion(step, options.seed);
    std::vector<Times> times =
        timed(methods, motion, kBlocks, GeodesicMotion::kCycle, true,
              [&](std::size_t m, const Poses& poses, const std::vector<Answer>& answers) {
                for (std::size_t i = 0; i < answers.size(); i += kCheckEvery) {
                  const Truth& truth = truths.of(poses, i, methods[m]->smooth);
                  if (truth.proven) records[m].add(answers[i], truth, methods[m]->smooth);
                }
              });
    std::map<std::string, Curve> data;
    for (std::size_t m = 0; m < methods.size(); ++m) {
      Record& r = records[m];
      const double apart = spread(times[m].block);
      chart.spread = std::max(chart.spread, apart);
      std::vector<double>& ns = times[m].query;
      const double d50 = percentile(r.distance, 0.5), d99 = percentile(r.distance, 0.99),
                   dMax = percentile(r.distance, 1), n50 = percentile(r.normal, 0.5),
                   n99 = percentile(r.normal, 0.99), nMax = percentile(r.normal, 1);
      const double low = percentile(ns, 0.05), middle = percentile(ns, 0.5), high = percentile(ns, 0.99);
      chart.rows.push_back(text("%s,%s,%s,%.0f,%.0f,%.0f,%.2g,%.2g,%.2g,%.2g,%.2g,%.2g,%zu,%d,%d,%d,%.3f",
                                step.name, methods[m]->name.c_str(), methods[m]->setting.c_str(), low, middle,
                                high, d50, d99, dMax, n50, n99, nMax, ns.size(), r.checked, r.wrong, r.missed,
                                apart));
      // Drawn at the 99th percentile, bars from the median to the worst.
      Curve& curve = data[methods[m]->name];
      curve.checked += r.checked;
      curve.wrong += r.wrong;
      curve.missed += r.missed;
      curve.rows += text("%g %g %g %g %g %g %g %g %g\n", d50, d99, dMax, n50, n99, nMax, low, middle, high);
    }
    plot += panels(step.name, data);
  }
  chart.plot = plot + "unset multiplot\n";
  chart.caption = text(
      "Geodesic spheres of 162 vertices. Polyhedral methods against the polyhedra, STP-BV against the "
      "STP-BVs. Point: median "
      "time, p99 of the error; bars: p5 to p99, median to worst. Seed %llu",
      static_cast<unsigned long long>(options.seed));
  return chart;
}

}  // namespace fcl_stpbv::benchmark
