// Extreme bodies and radii: thin, tiny, huge, almost degenerate, almost cospherical, with very few or very
// many vertices.
#include <cmath>
#include <cstdio>

#include "test/reference/stability/situation.h"

namespace fcl_stpbv::stability {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::Random;

namespace {

/// Placements of two bodies about their own size apart and close together, in random directions and
/// orientations.
std::vector<Placement> around(Random& random, const Body& a, const Body& b, int count) {
  const StpBv &va = a.smooth->volume(), &vb = b.smooth->volume();
  const double size = va.enclosingRadius() + vb.enclosingRadius();
  std::vector<Placement> placements;
  for (int i = 0; i < count; ++i) {
    const Matrix3d qa = random.rotation(), qb = random.rotation();
    const double apart = size * (i % 2 ? random.uniform(1.01, 1.2) : random.uniform(1.5, 3));
    const Vector3d t = apart * random.direction();
    placements.push_back({test::pose(qa, -(qa * va.centre())), test::pose(qb, t - qb * vb.centre())});
  }
  return placements;
}

struct Maker {
  std::vector<Situation>& all;
  Random random;

  void add(const std::string& group, const std::string& name, std::shared_ptr<const Body> a,
           std::shared_ptr<const Body> b, std::vector<Placement> placements) {
    Situation s;
    s.group = group;
    s.name = name;
    s.a = std::move(a);
    s.b = std::move(b);
    s.placements = std::move(placements);
    all.push_back(std::move(s));
  }
  void add(const std::string& group, const std::string& name, const std::shared_ptr<const Body>& a,
           const std::shared_ptr<const Body>& b, int count = 6) {
    add(group, name, a, b, around(random, *a, *b, count));
  }
};

Cloud scaled(Cloud cloud, double factor) {
  for (Vector3d& p : cloud) p *= factor;
  return cloud;
}

Cloud onSphere(Random& random, int count, double radius, double noise) {
  Cloud cloud;
  for (int i = 0; i < count; ++i)
    cloud.push_back((radius + noise * random.uniform(-1, 1)) * random.direction());
  return cloud;
}

void addThin(Maker& m) {
  const StpBvOptions usual{0.01, 10.0};
  for (const double ratio : {1e2, 1e3, 1e4, 1e5}) {
    const auto plate = makeBody(test::box(0.5, 0.4, 0.5 / ratio), usual);
    const auto needle = makeBody(test::box(0.5 / ratio, 0.5 / ratio, 0.5), usual);
    m.add("plates and needles", formatted("plates %.0e:1", ratio), plate, plate);
    m.add("plates and needles", formatted("needles %.0e:1", ratio), needle, needle);
    m.add("plates and needles", formatted("plate and needle %.0e:1", ratio), plate, needle);
    const double gap = 0.03;
    m.add("plates and needles", formatted("plates %.0e:1, face to face", ratio), plate, plate,
          {{test::pose(Matrix3d::Identity(), {0, 0, 0}),
            test::pose(Matrix3d::Identity(), {0.02, 0.01, 0.5 / ratio + gap})},
           {test::pose(Matrix3d::Identity(), {0, 0, 0}),
            test::pose(m.random.rotation(1e-9), {0.02, 0.01, 0.5 / ratio + gap})}});
  }
}

void addScales(Maker& m, std::uint64_t seed) {
  for (int exponent = -4; exponent <= 3; ++exponent) {
    const double scale = std::pow(10.0, exponent);
    const StpBvOptions radii{0.05 * scale, 50 * scale};
    const auto box = makeBody(scaled(test::box(1.5, 1, 0.7), scale), radii);
    const auto hull = makeBody(scaled(test::randomHull(40, {1, 0.7, 0.5}, seed), scale), radii);
    const auto drum = makeBody(scaled(test::cylinder(0.5, 1.2), scale), radii);
    m.add("scales 1e-4 to 1e3 m", formatted("boxes of %.0e m", scale), box, box);
    m.add("scales 1e-4 to 1e3 m", formatted("hulls of %.0e m", scale), hull, hull);
    m.add("scales 1e-4 to 1e3 m", formatted("drum and box of %.0e m", scale), drum, box);
  }
}

void addNearDegenerate(Maker& m) {
  const StpBvOptions usual{0.01, 10.0};
  for (int exponent = -16; exponent <= -6; exponent += 2) {
    const double noise = std::pow(10.0, exponent);
    Cloud doubled = test::box(0.3, 0.2, 0.25), sliver, subdivided;
    for (const Vector3d& p : test::box(0.3, 0.2, 0.25)) doubled.push_back(p + noise * m.random.direction());
    for (const double x : {-0.2, 0.0, 0.2})
      for (const double z : {-0.1, 0.1}) sliver.emplace_back(x, noise * m.random.uniform(-1, 1), z);
    sliver.emplace_back(0.05, 0.1, 0.02);
    const auto twice = makeBody(doubled, usual), thin = makeBody(sliver, usual);
    m.add("slivers and near-duplicates", formatted("vertices twice, %.0e m apart", noise), twice, twice);
    m.add("slivers and near-duplicates", formatted("a face of slivers %.0e m high", noise), thin, thin);
    const auto ball = makeBody(onSphere(m.random, 60, 0.2, noise), usual);
    const auto snug = makeBody(onSphere(m.random, 40, 0.2, noise), {0.0, 0.2 * (1 + 1e-3) + noise});
    m.add("cospherical points", formatted("60 points, moved by %.0e m", noise), ball, ball);
    m.add("cospherical points", formatted("40 points, moved by %.0e m, R near their radius", noise), snug,
          snug);
  }
  // A face of many coplanar points that are out of the plane by less than rounding, on which hill climbing
  // stops early.
  for (const double noise : {1e-17, 1e-12}) {
    Cloud grid;
    for (int i = 0; i <= 8; ++i)
      for (int j = 0; j <= 8; ++j)
        for (const double z : {-0.05, 0.05})
          grid.emplace_back(0.05 * i - 0.2, 0.05 * j - 0.2, z + noise * m.random.uniform(-1, 1));
    const auto tile = makeBody(grid, usual);
    m.add("subdivided planar faces", formatted("9 x 9 points a face, %.0e m of noise", noise), tile, tile);
    std::vector<Placement> stacked;
    for (const double x : {0.0, 0.025, 0.05, 0.39})
      stacked.push_back(
          {test::pose(Matrix3d::Identity(), {0, 0, 0}), test::pose(Matrix3d::Identity(), {x, 0.01, 0.13})});
    m.add("subdivided planar faces", formatted("9 x 9 points a face, %.0e m of noise, stacked", noise), tile,
          tile, stacked);
  }
}

void addRadii(Maker& m, std::uint64_t seed) {
  struct Shape {
    const char* name;
    Cloud cloud;
  };
  for (const Shape& shape :
       {Shape{"box", test::box(0.3, 0.2, 0.25)}, Shape{"hull", test::randomHull(30, {0.2, 0.15, 0.1}, seed)},
        Shape{"drum", test::cylinder(0.1, 0.2)}, Shape{"needle", test::needle(0.5)}}) {
    for (const double r : {0.0, 0.01}) {
      const double least = StpBv::smallestR(shape.cloud, r);
      const std::string margin = r > 0 ? ", r = 1 cm" : ", r = 0";
      for (const double beyond : {1e-9, 1e-6, 1e-3}) {
        const auto body = makeBody(shape.cloud, {r, least * (1 + beyond)});
        m.add("R near the smallest", shape.name + formatted(", R = smallest (1 + %.0e)", beyond) + margin,
              body, body);
      }
      const auto flat = makeBody(shape.cloud, {r, 1e6});
      m.add("R = 1e6 m", shape.name + margin, flat, flat);
    }
    const auto bare = makeBody(shape.cloud, {0.0, 1.0});
    m.add("r = 0", std::string(shape.name) + ", R = 1 m", bare, bare);
  }
}

void addCounts(Maker& m, bool large) {
  const StpBvOptions usual{0.01, 10.0};
  const auto box = makeBody(test::box(0.3, 0.2, 0.25), usual);
  const std::vector<Cloud> few{{{0.1, 0.2, -0.1}},
                               {{0, 0, -0.2}, {0.1, 0, 0.2}},
                               {{0.2, 0, 0}, {-0.1, 0.2, 0}, {-0.1, -0.2, 0}},
                               {{0.2, 0, 0}, {-0.1, 0.2, 0}, {-0.1, -0.2, 0}, {0, 0, 0.25}}};
  for (std::size_t i = 0; i < few.size(); ++i) {
    const auto body = makeBody(few[i], usual);
    m.add("vertex counts 1, 2, 3, 4, 100000", std::to_string(i + 1) + " against itself", body, body);
    m.add("vertex counts 1, 2, 3, 4, 100000", std::to_string(i + 1) + " against a box", body, box);
  }
  const auto crowd = makeBody(test::randomHull(100000, {0.2, 0.15, 0.1}, 5), usual);
  m.add("vertex counts 1, 2, 3, 4, 100000", "100000, most of them inside, against a box", crowd, box);
  if (!large) return;
  Random random(6);  // a generator of its own, so that the cases after it are the same without it
  const auto ball = makeBody(onSphere(random, 100000, 0.2, 0), usual);
  m.add("vertex counts 1, 2, 3, 4, 100000", "100000 on a sphere, against a box", ball, box,
        around(random, *ball, *box, 2));
}

/// A hull and its mirror image in mirrored poses, like a left and a right limb.
void addMirrored(Maker& m, std::uint64_t seed) {
  const StpBvOptions usual{0.01, 10.0};
  const Vector3d flip(1, -1, 1);
  const Matrix3d across = flip.asDiagonal();
  for (const int count : {4, 8, 20, 50, 200}) {
    const Cloud left = test::randomHull(count, {0.2, 0.1, 0.15}, seed + static_cast<std::uint64_t>(count));
    Cloud right = left;
    for (Vector3d& p : right) p = across * p;
    std::vector<Placement> placements;
    for (int i = 0; i < 12; ++i) {
      const Matrix3d q = m.random.rotation();
      const Vector3d t(m.random.uniform(-0.3, 0.3), m.random.uniform(0.26, 0.5), m.random.uniform(-0.3, 0.3));
      placements.push_back({test::pose(q, t), test::pose(across * q * across, across * t)});
    }
    m.add("mirrored hulls", std::to_string(count) + " points and their mirror image", makeBody(left, usual),
          makeBody(right, usual), placements);
  }
}

void addGrid(Maker& m) {
  const StpBvOptions usual{0.01, 10.0};
  const auto unit = makeBody(test::box(1, 1, 1), usual), slab = makeBody(test::box(1, 2, 0.5), usual);
  for (int i = 0; i < 6; ++i) {
    const Vector3d steps[] = {{2, 0, 0}, {2, 2, 0}, {2, 2, 2}, {3, 1, 0}, {0, 4, 1}, {1, 1, 3}};
    const Placement at{test::pose(Matrix3d::Identity(), {0, 0, 0}),
                       test::pose(Matrix3d::Identity(), steps[i])};
    m.add("boxes on a grid", formatted("unit boxes, neighbour %d", i + 1), unit, unit, {at});
    m.add("boxes on a grid", formatted("box and slab, neighbour %d", i + 1), unit, slab, {at});
  }
}

}  // namespace

void addBodies(std::vector<Situation>& all, std::uint64_t seed, bool large) {
  Maker m{all, Random(seed + 3)};
  addThin(m);
  addScales(m, seed);
  addNearDegenerate(m);
  addRadii(m, seed);
  addCounts(m, large);
  addMirrored(m, seed);
  addGrid(m);
}

}  // namespace fcl_stpbv::stability
