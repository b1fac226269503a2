// shape_soak POSES SEED [SHAPE]: random poses of an STP-BV against each simple shape. All are compared with
// the independent reference, in both orders; gradient and Hessian with differences; the turn of the normal
// with its Lipschitz bound. Prints one line per shape. Fails on any error above 1e-12 m (1e-9 for cone and
// ellipsoid), any difference between the orders, witness points that do not face each other, and any bound
// exceeded.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/distance/hessian.h"
#include "test/reference/arguments.h"
#include "test/reference/shape_reference.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

struct Body {
  Cloud cloud;
  double r, R;
  StpBv::Ptr volume;
};

std::vector<Body> bodies() {
  std::vector<Body> all;
  const auto add = [&](const Cloud& cloud, double r, double R) {
    all.push_back({cloud, r, R, StpBv::build(cloud, {r, R})});
  };
  add(box(0.3, 0.2, 0.1), 0.01, 10);
  add(plate(0.3, 0.2), 0.005, 10);
  add(needle(0.5), 0.01, 1);
  add(cylinder(0.1, 0.4, 16), 0.02, 100);
  add(geodesicSphere(0.2, 1), 0.01, 1);
  add(randomHull(20, {0.2, 0.15, 0.1}, 3), 0.01, 10);
  add({{0, 0, 0}, {0.3, 0, 0}}, 0.02, 0.5);
  add(box(0.2, 0.2, 0.2), 0, 10);
  return all;
}

/// A pose at which the bodies are near, touching, slightly deep or far. In some of them they are parallel.
Isometry3d placed(Random& random, const TestShape& shape, const Body& body) {
  Eigen::Matrix3d turn = random.rotation();
  if (random.below(4) == 0) {
    turn = Eigen::Matrix3d::Identity();
    if (random.below(2) == 0) turn = random.rotation(1e-6);
  }
  const Vector3d d = random.direction();
  Isometry3d at = pose(turn, d);
  // Along d, place the shape's near side at a chosen gap from the volume's far side.
  if (shape.shape.unbounded()) return at;
  const double reach = d.dot(at.linear() * shape.shape.support(-(turn.transpose() * d))) - shape.shape.margin;
  const double gap = random.below(3) == 0 ? random.uniform(-2, 2) * body.r : random.uniform(0, 0.5);
  at.translation() = (body.volume->support(d) + gap - reach) * d + 0.05 * random.direction();
  return at;
}

/// The reference's answer. For half spaces and planes the normal is given.
ReferenceAnswer truthOf(const ReferenceBody& a, const TestShape& shape, const Isometry3d& base,
                        const Isometry3d& at) {
  if (!shape.shape.unbounded())
    return referenceDistance(a, shape.posed(at),
                             (at * shape.shape.centre - base.translation()).cast<long double>());
  const Vector3L n = (at.linear() * shape.shape.normal).cast<long double>().normalized();
  const long double height = n.dot(at.translation().cast<long double>()) + shape.shape.offset;
  const long double above = -height - referenceSupport(a, -n), below = height - referenceSupport(a, n);
  const bool down = shape.shape.kind == ShapeKind::halfspace || above >= below;
  return {down ? above : below, down ? Vector3L(-n) : n, false};
}

/// The gap along a normal, from supports in long double.
double gapAlong(const ReferenceBody& a, const ReferenceShape& b, const Vector3d& normal) {
  const Vector3L n = normal.cast<long double>();
  return static_cast<double>(n.dot(b.support(-n)) - b.margin - referenceSupport(a, n));
}

/// Errors of an answer's derivatives compared with other poses, as shares of what theory allows.
struct Derivatives {
  double gradient = 0;  ///< central difference of the distance against the gradient
  double second = 0;    ///< central difference of the gradient against the Hessian
  double smooth = 0;    ///< error of the gradient where no region boundary is within the step
  double turn = 0;      ///< turn of the normal under a translation (docs/theory.md, 6)
};

/// Compares along a random twist of the shape over +-h. The second derivative jumps at region boundaries. So
/// a central difference of the distance may be off by half a step times the differences of the three Hessians
/// there, and a difference of the gradient lies between them. False if something that the Hessians do not
/// show, a feature smaller than the step, spoils the comparison.
bool differences(const Body& body, const Shape& shape, const Isometry3d& base, const Isometry3d& at,
                 const Distance& d, const Eigen::Matrix<double, 6, 1>& twist, double h, Derivatives& parts) {
  const double core = d.distance + body.r + shape.margin;
  const auto rates = [&](const Isometry3d& there, const Distance& e, double& speed, double& second) {
    DistanceHessian hessian;
    if (!fcl_stpbv::hessian(*body.volume, base, shape, there, e, hessian)) return false;
    speed = e.gradient(1, there.translation()).dot(twist);
    second = twist.dot(hessian.matrix.bottomRightCorner<6, 6>() * twist);
    return true;
  };
  double speed[3], second[3], value[3];
  for (int k = 0; k < 3; ++k) {
    Isometry3d there = at;
    if (k != 1) {
      const double t = (k - 1) * h, angle = twist.tail<3>().norm();
      there.linear() =
          Eigen::AngleAxisd(t * angle, twist.tail<3>().normalized()).toRotationMatrix() * at.linear();
      there.translation() += t * twist.head<3>();
    }
    const Distance e = k == 1 ? d : distance(*body.volume, base, shape, there);
    value[k] = e.distance;
    // A plane that is as deep on its other side: a kink.
    if (shape.unbounded() && e.normal.dot(d.normal) < 0.0) {
      parts = {};
      return false;
    }
    if (!rates(there, e, speed[k], second[k])) return true;
  }
  const double low = std::min({second[0], second[1], second[2]}),
               high = std::max({second[0], second[1], second[2]});
  const double error = std::abs((value[2] - value[0]) / (2 * h) - speed[1]);
  const double rounding = 8 * 2.2e-16 * (4 + at.translation().norm()) / h;
  Derivatives here;
  here.gradient = error / (0.5 * h * (high - low) + rounding);
  if (0.5 * h * (high - low) < rounding) here.smooth = error;
  const double between = (speed[2] - speed[0]) / (2 * h);
  // An ulp of the normal moves the core's point by rho ulps. That changes the normal by the same divided by
  // the cores' distance.
  const double rounded =
      16 * 2.2e-16 * (body.volume->radii().rho + 4) * (1 + (shape.unbounded() ? 0 : 1 / core)) / h;
  here.second = std::max({0.0, between - high, low - between}) / (0.1 * (high - low) + rounded);
  parts.smooth = here.smooth;
  parts.gradient = here.gradient;
  parts.second = here.second;
  return here.gradient <= 1 && here.second <= 1;
}

Derivatives derivativesOf(const Body& body, const Shape& shape, const Isometry3d& base, const Isometry3d& at,
                          const Distance& d, Random& random) {
  const double core = d.distance + body.r + shape.margin;
  Derivatives parts;
  Eigen::Matrix<double, 6, 1> twist;
  twist << random.direction(), random.direction();
  const double step = 1e-4 * (shape.unbounded() ? 1 : std::min(core, 1.0));
  for (const double part : {1.0, 0.1, 0.01, 0.001})
    if (differences(body, shape, base, at, d, twist, part * step, parts)) break;

  if (shape.unbounded()) return parts;  // the normal is always the plane's
  const double eps = 1e-3 * core;
  Isometry3d there = at;
  there.translation() += eps * random.direction();
  const Distance e = distance(*body.volume, base, shape, there);
  if (e.status != DistanceStatus::exact) return parts;
  // Between the two poses the cores may come slightly nearer than at either, by eps^2 / (8 nearer) to first
  // order, because no body's distance curves more than a point's.
  const double ends = std::min(core, e.distance + body.r + shape.margin);
  const double nearer = ends - eps * eps / (6 * ends);
  const double angle = 2 * std::asin(std::min(1.0, 0.5 * (e.normal - d.normal).norm()));
  // A normal is accurate to the rounding of the core's point (rho ulps) divided by the cores' distance.
  const double rounded = 16 * 2.2e-16 * (body.volume->radii().rho + 4) / nearer;
  parts.turn = angle / (eps / nearer + rounded);
  return parts;
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments(argc, argv, "[POSES [SEED [KIND]]]", 3);
  const int poses = arguments.number(1, 1000);
  const int seed = arguments.number(2, 1);
  const std::string only = arguments.text(3, "");
  const std::vector<Body> all = bodies();
  bool good = true;
  std::vector<std::string> names = boundedShapes();
  names.insert(names.end(), {"halfspace", "plane"});
  std::printf(
      "| shape | exact | bounded | overlap | missed | swapped | error (m) | deep (m) | askew | gradient | of "
      "allowed | "
      "second | turn | ns a query |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const std::string& name : names) {
    if (!only.empty() && only != name) continue;
    Random random(static_cast<std::uint64_t>(seed));
    int exact = 0, bounded = 0, overlap = 0, missed = 0, swapped = 0;
    double worst = 0, deep = 0, askew = 0, time = 0;
    Derivatives most;
    for (int i = 0; i < poses; ++i) {
      const Body& body = all[static_cast<std::size_t>(random.below(static_cast<int>(all.size())))];
      const TestShape shape = randomShape(name, random);
      const Isometry3d base = pose(random.rotation(), random.direction());
      const Isometry3d at = base * placed(random, shape, body);
      const auto begin = std::chrono::steady_clock::now();
      const Distance d = distance(*body.volume, base, shape.shape, at);
      time += std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count();
      const Distance other = distance(shape.shape, at, *body.volume, base);
      swapped += other.distance != d.distance || other.normal != -d.normal || other.point[0] != d.point[1] ||
                 other.point[1] != d.point[0];
      const ReferenceBody a = referenceBody(body.cloud, body.r, body.R, base);
      const ReferenceShape b = shape.posed(at);
      const ReferenceAnswer truth = truthOf(a, shape, base, at);
      // The gap along any normal is at most the distance. The reference may stop before the widest gap, or at
      // an overlap, if cores are micrometres apart. Then the answer's own normal gives a better value.
      const double along =
          shape.shape.unbounded() ? static_cast<double>(truth.distance) : gapAlong(a, b, d.normal);
      if (truth.overlap && !(along + body.r + shape.shape.margin > 0)) {
        ++overlap;
        if (d.status == DistanceStatus::exact && d.distance + body.r + shape.shape.margin > 1e-13) {
          ++missed;
        }
        // Only directions can be compared: no gap may be wider than the bound, or wider than the answer by
        // more than the search's tolerance. Along its own normal the answer must equal the supports.
        const auto widest = static_cast<double>(widestGapOverDirections(a, b, 500));
        deep = std::max({deep, widest - d.distance, widest - d.upper, std::abs(along - d.distance)});
        if (widest - d.distance > 1e-6 * (1e-3 - widest) || widest - d.upper > 1e-12 ||
            std::abs(along - d.distance) > 1e-12) {
          ++missed;
          std::printf("  %s %d: deep, body %d distance %.17g upper %.17g widest %.17g along %.17g\n",
                      name.c_str(), i, static_cast<int>(&body - all.data()), d.distance, d.upper, widest,
                      along);
        }
        continue;
      }
      constexpr double kShort = 1e-12;  // m; more than the rounding of both
      const bool stopped = along > static_cast<double>(truth.distance) + kShort;
      const double error =
          std::abs(stopped ? d.distance - along : static_cast<double>(d.distance - truth.distance));
      if (d.status == DistanceStatus::exact) ++exact;
      if (d.status == DistanceStatus::bounded) ++bounded;
      if (d.status == DistanceStatus::local) ++missed;
      if (error > 1e-12 || d.status != DistanceStatus::exact)
        std::printf("  %s %d: body %d status %d distance %.17g truth %.17Lg error %.2g upper-lower %.2g\n",
                    name.c_str(), i, static_cast<int>(&body - all.data()), static_cast<int>(d.status),
                    d.distance, truth.distance, error, d.upper - d.lower);
      constexpr double kApart = 1e-4;  // if cores are nearer, the normal turns faster than the steps resolve
      if (d.status == DistanceStatus::exact &&
          (shape.shape.unbounded() || d.distance + body.r + shape.shape.margin > kApart)) {
        const Derivatives parts = derivativesOf(body, shape.shape, base, at, d, random);
        if (parts.gradient > 1 || parts.second > 1 || parts.turn > 1)
          std::printf("  %s %d: gradient %.3g, second %.3g, turn %.3g of what is allowed\n", name.c_str(), i,
                      parts.gradient, parts.second, parts.turn);
        most.gradient = std::max(most.gradient, parts.gradient);
        most.second = std::max(most.second, parts.second);
        most.smooth = std::max(most.smooth, parts.smooth);
        most.turn = std::max(most.turn, parts.turn);
      }
      // The witness points face each other. An ulp of the normal moves a core's point by rho ulps.
      const double off = (d.point[1] - d.point[0] - d.distance * d.normal).norm();
      askew = std::max(askew, off / (16 * 2.2e-16 * (body.volume->radii().rho + 4)));
      worst = std::max(worst, error);
    }
    std::printf("| %s | %d | %d | %d | %d | %d | %.1e | %.1e | %.2f | %.1e | %.2f | %.3f | %.3f | %.0f |\n",
                name.c_str(), exact, bounded, overlap, missed, swapped, worst, deep, askew, most.smooth,
                most.gradient, most.second, most.turn, time / poses);
    std::fflush(stdout);
    const double allowed = name == "cone" || name == "ellipsoid" ? 1e-9 : 1e-12;
    good = good && missed == 0 && bounded == 0 && worst <= allowed && swapped == 0 && askew <= 1 &&
           most.gradient <= 1 && most.second <= 1 && most.turn <= 1;
  }
  return good ? 0 : 1;
}
