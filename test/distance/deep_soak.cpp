// deep_soak PAIRS SEED: STP-BVs that overlap by more than their margins, against a reference that shares no
// code with the library: the overlap along thousands of directions from the vertices alone, then a refinement
// of every candidate with the support function computed from its definition. Prints one line per pair of
// shapes. Fails if it finds a wider gap than the library, or if an answer differs from its supporting planes.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "fcl_stpbv/distance/distance.h"
#include "test/reference/arguments.h"
#include "test/reference/reference.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

struct Body {
  std::string name;
  Cloud cloud;
  double r;
  std::vector<StpBv::Ptr> volumes{};  // with R a thousandth above the smallest, and with kBigRadii
};

const std::array<double, 4> kBigRadii{0.32, 1, 10, 100};  // the first is barely enough for the longest body

std::vector<Body> bodies() {
  std::vector<Body> all;
  const auto add = [&](const char* name, const Cloud& cloud, double r) {
    Body body{name, cloud, r};
    body.volumes.push_back(StpBv::build(cloud, {r, 1.001 * StpBv::smallestR(cloud, r)}));
    for (const double R : kBigRadii) body.volumes.push_back(StpBv::build(cloud, {r, R}));
    all.push_back(body);
  };
  add("box", box(0.3, 0.2, 0.1), 0.01);
  add("cube", box(0.2, 0.2, 0.2), 0);
  add("plate", plate(0.3, 0.2), 0.005);
  add("needle", needle(0.5), 0.005);
  add("cylinder", cylinder(0.1, 0.3, 32), 0.01);
  add("geodesic", geodesicSphere(0.15, 2), 0.01);
  add("hull", randomHull(200, {0.2, 0.15, 0.1}, 3), 0.01);
  Cloud link = cylinder(0.05, 0.4, 16);  // a limb: a cylinder with a wider head
  for (const Vector3d& p : box(0.16, 0.12, 0.08)) link.push_back(p + Vector3d(0.02, 0, 0.2));
  add("link", link, 0.01);
  return all;
}

/// A posed body's support function in double precision, from the lowest centre along `n` whose ball of radius
/// rho contains all points. At most three points are active (docs/theory.md, 1).
class Support {
 public:
  Support(const Body& body, double R, const Isometry3d& at) : r_(body.r), rho_(R - body.r) {
    for (const Vector3d& p : body.cloud) points_.push_back(at * p);
  }
  /// Support of the points' hull. It is at most the body's, and lower by at most the faces' bulge.
  double hull(const Vector3d& n) const {
    double most = -1e300;
    for (const Vector3d& p : points_) most = std::max(most, n.dot(p));
    return most;
  }
  double exact(const Vector3d& n) const {
    std::vector<Vector3d> basis{*std::max_element(points_.begin(), points_.end(),
                                                  [&](auto& p, auto& q) { return n.dot(p) < n.dot(q); })};
    Vector3d centre = basis[0] - rho_ * n;
    for (int i = 0; i < 50; ++i) {
      const Vector3d* worst = nullptr;
      double miss = 1e-13 * (1 + rho_);
      for (const Vector3d& p : points_)
        if (const double m = (p - centre).norm() - rho_; m > miss) miss = m, worst = &p;
      if (!worst) break;
      basis.push_back(*worst);
      centre = lowest(basis, n);
    }
    return r_ + rho_ + n.dot(centre);
  }

 private:
  /// The lowest feasible centre for up to four points, over all their subsets. `basis` becomes the best
  /// subset.
  Vector3d lowest(std::vector<Vector3d>& basis, const Vector3d& n) const {
    const std::vector<Vector3d> all = basis;
    double leastMiss = 1e300, height = 1e300;
    Vector3d best = all[0] - rho_ * n;
    const double tolerance = 1e-13 * (1 + rho_);
    for (unsigned subset = 1; subset < (1u << all.size()); ++subset) {
      std::vector<Vector3d> p;
      for (std::size_t i = 0; i < all.size(); ++i)
        if (subset >> i & 1u) p.push_back(all[i]);
      if (p.size() > 3) continue;
      Vector3d middle = p[0], down = n;  // the points' centre, and the direction from it to the ball's centre
      double reach2 = 0;
      if (p.size() == 2) {
        middle = 0.5 * (p[0] + p[1]);
        const Vector3d u = (p[1] - p[0]).normalized();
        reach2 = 0.25 * (p[1] - p[0]).squaredNorm();
        down = (n - n.dot(u) * u).normalized();
      }
      if (p.size() == 3) {
        const Vector3d e = p[1] - p[0], f = p[2] - p[0], x = e.cross(f);
        if (!(x.norm() > 1e-14)) continue;
        const Vector3d c =
            (f.squaredNorm() * x.cross(e) + e.squaredNorm() * f.cross(x)) / (2 * x.squaredNorm());
        middle = p[0] + c;
        reach2 = c.squaredNorm();
        down = n.dot(x) > 0 ? x.normalized() : Vector3d(-x.normalized());
      }
      if (!(rho_ * rho_ >= reach2)) continue;
      const Vector3d centre = middle - std::sqrt(rho_ * rho_ - reach2) * down;
      double miss = 0;
      for (const Vector3d& q : all) miss = std::max(miss, (q - centre).norm() - rho_);
      const bool better =
          miss <= tolerance ? leastMiss > tolerance || n.dot(centre) < height : miss < leastMiss;
      if (!better) continue;
      best = centre;
      basis = p;
      height = n.dot(centre);
      leastMiss = miss;
    }
    return best;
  }

  std::vector<Vector3d> points_;
  double r_, rho_;
};

/// Moves `n` by the steps of a shrinking compass as long as they widen the gap.
template <typename Gap>
double polish(const Gap& gap, Vector3d& n, double step, double finest) {
  double best = gap(n);
  while (step > finest) {
    const Vector3d e = n.unitOrthogonal(), f = n.cross(e);
    bool grew = false;
    for (int k = 0; k < 12; ++k) {
      const double angle = 0.5235987755982988 * k + 7 * step;  // turned a little in each round
      const Vector3d m = (n + step * (std::cos(angle) * e + std::sin(angle) * f)).normalized();
      const double g = gap(m);
      if (g > best) best = g, n = m, grew = true;
    }
    if (!grew) step *= 0.5;
  }
  return best;
}

/// The widest gap between two overlapping bodies, by brute force.
double widestGap(const Support& a, const Support& b, double bulge) {
  constexpr int kDirections = 6000;
  // Rad, more than the distance to the nearest direction.
  const double spacing = 3.6 / std::sqrt(kDirections);
  const auto hulls = [&](const Vector3d& n) { return -a.hull(n) - b.hull(-n); };
  const auto exact = [&](const Vector3d& n) { return -a.exact(n) - b.exact(-n); };
  static const std::vector<Vector3d> directions = [] {
    std::vector<Vector3d> all;
    const double golden = std::acos(-1.0) * (3 - std::sqrt(5.0));
    for (int i = 0; i < kDirections; ++i) {  // Fibonacci spiral
      const double z = 1 - (2 * i + 1) / static_cast<double>(kDirections), w = std::sqrt(1 - z * z);
      all.emplace_back(w * std::cos(golden * i), w * std::sin(golden * i), z);
    }
    return all;
  }();
  std::vector<std::pair<double, Vector3d>> trials;
  for (const Vector3d& n : directions) trials.emplace_back(hulls(n), n);
  std::sort(trials.begin(), trials.end(), [](auto& p, auto& q) { return p.first > q.first; });
  // Refine the best of each neighbourhood on the hulls. Then compute those within the bulge of the best
  // exactly.
  std::vector<std::pair<double, Vector3d>> tops;
  std::vector<Vector3d> seen;
  for (std::size_t i = 0; i < trials.size() && seen.size() < 60; ++i) {
    Vector3d n = trials[i].second;
    if (std::any_of(seen.begin(), seen.end(), [&](auto& s) { return s.dot(n) > 1 - 2 * spacing * spacing; }))
      continue;
    seen.push_back(n);
    const double g = polish(hulls, n, 0.5 * spacing, 1e-4);
    tops.emplace_back(g, n);
  }
  std::sort(tops.begin(), tops.end(), [](auto& p, auto& q) { return p.first > q.first; });
  double best = -1e300;
  std::vector<Vector3d> done;
  for (auto& [g, n] : tops) {
    if (g < tops[0].first - bulge - 1e-4) break;
    if (std::any_of(done.begin(), done.end(), [&, m = n](auto& s) { return s.dot(m) > 1 - 1e-6; })) continue;
    done.push_back(n);
    best = std::max(best, polish(exact, n, 0.02, 1e-7));
  }
  return best;
}

struct Row {
  int pairs = 0, exact = 0, local = 0, bounded = 0, best = 0;
  double missed = 0;  ///< widest gap beyond the answer (m)
  double error = 0;   ///< error of the answer along its own normal (m)
  double open = 0;    ///< largest upper bound minus lower bound (m)
  double nanoseconds = 0;
  void add(const Row& o) {
    pairs += o.pairs, exact += o.exact, local += o.local, bounded += o.bounded, best += o.best;
    missed = std::max(missed, o.missed), error = std::max(error, o.error), open = std::max(open, o.open);
    nanoseconds += o.nanoseconds;
  }
  void print(const std::string& name) const {
    std::printf("| %s | %d | %d | %d | %d | %d | %.1e | %.1e | %.1e | %.1f |\n", name.c_str(), pairs, exact,
                local, bounded, best, missed, error, open, 1e-3 * nanoseconds / std::max(pairs, 1));
    std::fflush(stdout);
  }
};

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments(argc, argv, "[COUNT [SEED]]", 2);
  const int count = arguments.number(1, 200);
  Random random(arguments.number(2, std::uint64_t{1}));
  const std::vector<Body> all = bodies();
  std::map<std::string, Row> rows;
  Row total;
  bool good = true;
  for (int i = 0; i < count;) {
    const Body& a = all[static_cast<std::size_t>(random.below(static_cast<int>(all.size())))];
    const Body& b = all[static_cast<std::size_t>(random.below(static_cast<int>(all.size())))];
    const auto which = static_cast<std::size_t>(random.below(static_cast<int>(kBigRadii.size()) + 1));
    const StpBv &va = *a.volumes[which], &vb = *b.volumes[which];
    const double Ra = va.radii().R, Rb = vb.radii().R;
    // A quarter is aligned, a quarter nearly so. The depth varies from contact to coinciding centres.
    Eigen::Matrix3d turn = random.rotation();
    const int kind = random.below(4);
    if (kind == 0) turn = Eigen::Matrix3d::Identity();
    if (kind == 1) turn = random.rotation(1e-3);
    const Isometry3d base = pose(random.rotation(), random.direction());
    const Vector3d way = random.direction();
    Isometry3d at = pose(turn, 2 * way);
    const Distance far = distance(va, Isometry3d::Identity(), vb, at);
    at.translation() *= random.uniform(0, 1) * (2 - std::max(far.distance, 0.0)) / 2;
    const Isometry3d pb = base * at;

    const auto begin = std::chrono::steady_clock::now();
    const Distance d = distance(va, base, vb, pb);
    const double ns =
        std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count();
    if (!(d.distance < -(a.r + b.r) - 1e-6)) continue;
    ++i;
    Row row;
    row.pairs = 1;
    row.nanoseconds = ns;
    row.exact = d.status == DistanceStatus::exact;
    row.local = d.status == DistanceStatus::local;
    row.bounded = d.status == DistanceStatus::bounded;
    row.open = d.upper - d.lower;
    // The bulge of all faces over the hull is at most the sagitta of the longest chord (docs/theory.md, 4).
    const auto bulge = [](double rho) { return rho - std::sqrt(rho * rho - std::min(0.09, rho * rho)); };
    const double truth = widestGap({a, Ra, base}, {b, Rb, pb}, bulge(va.radii().rho) + bulge(vb.radii().rho));
    row.missed = std::max(0.0, truth - d.distance);
    row.best = row.missed <= 1e-9;
    const long double along = referenceGap(referenceBody(a.cloud, a.r, Ra, base),
                                           referenceBody(b.cloud, b.r, Rb, pb), d.normal.cast<long double>());
    row.error = std::abs(static_cast<double>(along - d.distance));
    // Up to a small multiple of the rounding of rho, which is at most 100 m. Near the smallest R bodies are
    // balls, for which the polytope may run out of points.
    const bool wide = row.open > (Ra < 1 ? 2e-4 * -d.distance : 1e-12);
    if (!row.best || wide || row.error > 1e-13 || d.upper < truth - 1e-12 || d.lower > d.upper) {
      good = false;
      std::printf("  %d %s-%s R %g, %g status %d distance %.17g truth %.17g bounds %.3g error %.3g\n", i,
                  a.name.c_str(), b.name.c_str(), Ra, Rb, static_cast<int>(d.status), d.distance, truth,
                  d.upper - d.lower, row.error);
    }
    rows[std::min(a.name, b.name) + ", " + std::max(a.name, b.name)].add(row);
    total.add(row);
  }
  std::printf(
      "| pair | queries | exact | local | bounded | widest found | missed by (m) | error (m) | bounds (m) "
      "| us |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& [name, row] : rows) row.print(name);
  total.print("all");
  return good ? 0 : 1;
}
