// Time against the number of vertices: the paper's figure 8.
#include <algorithm>
#include <cmath>
#include <map>

#include "tools/bench/charts.h"
#include "tools/bench/timing.h"

namespace fcl_stpbv::benchmark {

namespace {

/// A method slower than this many seconds a point answers fewer calls; the CSV says how many.
constexpr double kSecondsAPoint = 30;

std::vector<MethodPtr> peers(const Bodies& bodies) {
  std::vector<MethodPtr> methods;
  methods.push_back(fclLibccd(bodies));
  methods.push_back(fclIndep(bodies));
  if (MethodPtr bullet = bulletGjk(bodies)) methods.push_back(std::move(bullet));
  methods.push_back(fclGapStop(bodies, true));
  methods.push_back(stpBvThroughFcl(bodies));
  methods.push_back(stpBvWarm(bodies));
  return methods;
}

std::string panel(const Step& step, const std::map<std::string, std::string>& data) {
  std::string plot, curves;
  int block = 0;
  for (const auto& [method, rows] : data) {
    const std::string name = text("$%s%d", step.name, block++);
    plot += name + " << EOD\n" + rows + "EOD\n";
    curves += (curves.empty() ? "plot " : ", ") + name + " using 1:3:2:4 with yerrorbars " + style(method) +
              " ps 0.01 lw 0.7 notitle, " + name + " using 1:3 with linespoints " + style(method) +
              " ps 0.8 lw 2 title '" + method + "'";
  }
  const bool large = step.turn > 0.1;
  return plot + text("set title '%s'\n", large ? "large steps: 20° and 2 cm" : "small steps: 1° and 1 mm") +
         (large ? "set ylabel ''\nset key off\n"
                : "set ylabel 'ns a query'\nset key top left reverse Left\n") +
         curves + "\n";
}

}  // namespace

Chart sizeChart(const ChartOptions& options) {
  Chart chart;
  chart.name = "size";
  chart.header = "steps,vertices,method,setting,ns_p5,ns_p50,ns_p99,ns_block_mean_p50,calls,failed,spread";
  chart.width = 1000;
  chart.height = 520;
  std::string plot =
      "set multiplot layout 1,2 margins 0.075,0.985,0.215,0.93 spacing 0.07\nset logscale xy\n"
      "set xlabel 'vertices'\nset xrange [9:14000]\nset yrange [50:4e6]\nset xtics "
      "(12,42,162,642,2562,10242)\n";
  for (const Step& step : {smallStep(), largeStep()}) {
    std::map<std::string, std::string> data;
    for (int subdivisions = 0; subdivisions <= 5; ++subdivisions) {
      const Bodies bodies = geodesicSpheres(subdivisions);
      const std::vector<MethodPtr> methods = peers(bodies);
      GeodesicMotion motion(step, options.seed);
      std::vector<int> failed(methods.size());
      const int blocks = std::max(1, static_cast<int>(options.calls / GeodesicMotion::kCycle));
      std::vector<Times> times = timed(
          methods, motion, blocks, GeodesicMotion::kCycle, true,
          [&](std::size_t m, const Poses&, const std::vector<Answer>& answers) {
            for (const Answer& a : answers) failed[m] += a.outcome == Outcome::failed;
          },
          kSecondsAPoint);
      for (std::size_t m = 0; m < methods.size(); ++m) {
        std::vector<double>& ns = times[m].query;
        const double low = percentile(ns, 0.05), middle = percentile(ns, 0.5), high = percentile(ns, 0.99),
                     mean = median(times[m].block), apart = spread(times[m].block);
        chart.spread = std::max(chart.spread, apart);
        const int vertices = bodies.a->volume().vertexCount();
        chart.rows.push_back(text("%s,%d,%s,%s,%.0f,%.0f,%.0f,%.0f,%zu,%d,%.3f", step.name, vertices,
                                  methods[m]->name.c_str(), methods[m]->setting.c_str(), low, middle, high,
                                  mean, ns.size(), failed[m], apart));
        data[methods[m]->name] += text("%d %g %g %g\n", vertices, low, middle, high);
      }
    }
    plot += panel(step, data);
  }
  chart.plot = plot + "unset multiplot\n";
  chart.caption = text(
      "Geodesic spheres of radius 0.20 m, centres 0.38 to 0.80 m apart, r = 1 cm, R = 10 m. Median, bars p5 "
      "to p99; at "
      "most %ld calls a point, seed %llu; counts of calls and failures in the CSV",
      options.calls, static_cast<unsigned long long>(options.seed));
  return chart;
}

}  // namespace fcl_stpbv::benchmark
