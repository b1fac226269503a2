// The jump test: a box rocks past parallel faces over a plate in n steps; how much does the gradient change
// between neighbours? A continuous gradient's change goes down as 1/n, a jump stays.
#include <algorithm>
#include <cmath>
#include <map>

#include "tools/bench/charts.h"
#include "tools/bench/method.h"

namespace fcl_stpbv::benchmark {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Rocks from -2 to 2 degrees, turned and tipped a little so that one corner at a time is nearest.
Isometry3d rocked(double t) {
  const double degree = std::acos(-1.0) / 180;
  const Matrix3d r =
      Matrix3d(AngleAxisd((4 * t - 2) * degree, Vector3d::UnitY()) *
               AngleAxisd(0.3 * degree, Vector3d::UnitX()) * AngleAxisd(20 * degree, Vector3d::UnitZ()));
  return test::pose(r, {0.01, 0.02, 0.2});
}

/// The derivative with respect to the upper body's twist about its origin.
Eigen::Matrix<double, 6, 1> gradientOf(const Answer& answer, const Isometry3d& pose) {
  const Vector3d n = answer.direction();
  Eigen::Matrix<double, 6, 1> g;
  g << n, (answer.point[1] - pose.translation()).cross(n);
  return g;
}

struct Jump {
  double largest = 0;
  int failed = 0;
};

Jump largestJump(Method& method, int steps) {
  Jump jump;
  Eigen::Matrix<double, 6, 1> last;
  bool known = false;
  for (int k = 0; k <= steps; ++k) {
    const Isometry3d pose = rocked(static_cast<double>(k) / steps);
    Answer answer;
    method.query(Isometry3d::Identity(), pose, answer);
    const Eigen::Matrix<double, 6, 1> g = gradientOf(answer, pose);
    if (answer.outcome != Outcome::apart || !g.allFinite()) {
      ++jump.failed;
      known = false;
      continue;
    }
    if (known) jump.largest = std::max(jump.largest, (g - last).norm());
    last = g;
    known = true;
  }
  return jump;
}

Bodies plateAndBox(double r, double R) {
  return {std::make_shared<StpBvGeometry>(StpBv::build(test::box(0.3, 0.3, 0.1), {r, R})),
          std::make_shared<StpBvGeometry>(StpBv::build(test::box(0.2, 0.2, 0.2), {r, R}))};
}

}  // namespace

Chart jumpChart(const ChartOptions&) {
  Chart chart;
  chart.name = "jump_test";
  chart.header = "method,setting,path_steps,largest_change,failed";
  chart.width = 720;
  chart.height = 480;
  const Bodies bodies = plateAndBox(0.01, 10);
  std::vector<MethodPtr> methods;
  methods.push_back(fclLibccd(bodies));
  methods.push_back(fclIndep(bodies));
  if (MethodPtr bullet = bulletGjk(bodies)) methods.push_back(std::move(bullet));
  methods.push_back(fclGapStop(bodies, true));
  methods.push_back(stpBvThroughFcl(bodies));
  methods.push_back(stpBvWarm(bodies));
  std::string curves;
  int block = 0;
  for (const MethodPtr& method : methods) {
    std::string rows;
    int failed = 0;
    for (const int steps : {30, 100, 300, 1000, 3000, 10000, 30000, 100000}) {
      const Jump jump = largestJump(*method, steps);
      failed += jump.failed;
      chart.rows.push_back(text("%s,%s,%d,%.4g,%d", method->name.c_str(), method->setting.c_str(), steps,
                                jump.largest, jump.failed));
      rows += text("%d %g\n", steps, jump.largest);
    }
    const std::string name = text("$jump%d", block++);
    chart.plot += name + " << EOD\n" + rows + "EOD\n";
    curves += ", " + name + " using 1:2 with linespoints " + style(method->name) + " ps 0.8 lw 2 title '" +
              method->name + (failed ? text(" (%d failed)", failed) : "") + "'";
  }
  chart.plot +=
      "set lmargin at screen 0.1\nset bmargin at screen 0.235\nset logscale xy\nset format '10^{%L}'\n"
      "set xlabel 'steps of the path'\nset ylabel 'largest change of the gradient in one step'\n"
      "set key bottom left reverse Left\nplot 30./x dt 2 lc rgb '#888888' title 'slope -1'" +
      curves + "\n";
  chart.caption =
      "A box of 20 cm rocks by 4 degrees past parallel faces over a plate; derivative with the box's twist. "
      "r = 1 cm, R = "
      "10 m";
  return chart;
}

}  // namespace fcl_stpbv::benchmark
