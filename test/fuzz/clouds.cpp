// Makes a random cloud:
// 1. Choose a kind of cloud.
// 2. Duplicate or add points.
// 3. Scale, turn and shift all points, and add noise or round them.
// 4. Choose R, from just above the smallest possible one to far above it.
#include "test/fuzz/clouds.h"

#include <cmath>

namespace fcl_stpbv::fuzz {

using Eigen::Vector3d;
using test::Cloud;
using test::Random;

namespace {

Cloud base(Random& random) {
  Cloud cloud;
  const int count = 1 + random.below(30);
  switch (random.below(7)) {
    case 0:  // a grid of small integers, in which points may repeat
      for (int i = 0; i < count; ++i) {
        const int side = 2 + random.below(3);
        const double x = random.below(side), y = random.below(side), z = random.below(side);
        cloud.emplace_back(x, y, z);
      }
      break;
    case 1:  // a circle, or two
      for (int i = 0; i < count; ++i) {
        const double angle = 2 * M_PI * i / count;
        cloud.emplace_back(std::cos(angle), std::sin(angle), random.below(2));
      }
      break;
    case 2:  // nearly on a line
      for (int i = 0; i < count; ++i) {
        const double along = random.uniform(-1, 1), off = std::pow(10.0, random.uniform(-16, -6));
        cloud.emplace_back(along, off * random.uniform(-1, 1), off * random.uniform(-1, 1));
      }
      break;
    case 3:  // nearly in a plane
      for (int i = 0; i < count; ++i) {
        const double x = random.below(5), y = random.below(5);
        cloud.emplace_back(x, y, std::pow(10.0, random.uniform(-17, -8)) * random.uniform(-1, 1));
      }
      break;
    case 4:  // on a sphere
      for (int i = 0; i < count; ++i) cloud.push_back(random.direction());
      break;
    case 5:  // a box and points on it
      cloud = test::box(1, 2, 0.5);
      for (int i = 0; i < count; ++i)
        cloud.emplace_back(0.5 * random.uniform(-1, 1), random.uniform(-1, 1),
                           random.below(2) ? 0.25 : -0.25);
      break;
    default:  // random points
      for (int i = 0; i < count; ++i) cloud.push_back(random.uniform(0, 1) * random.direction());
      break;
  }
  return cloud;
}

}  // namespace

CloudCase nastyCloud(Random& random) {
  CloudCase c;
  c.points = base(random);
  if (random.below(3) == 0) {  // copies of some points, next to them
    const double apart = std::pow(10.0, random.uniform(-17, -9));
    const std::size_t count = c.points.size();
    for (std::size_t i = 0; i < count; ++i)
      for (int k = random.below(4); k > 0; --k) c.points.push_back(c.points[i] + apart * random.direction());
  }
  const double scale = std::pow(10.0, random.uniform(-4, 3));
  const Eigen::Matrix3d turn =
      random.below(2) ? random.rotation() : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  const double away = random.below(2) ? scale * std::pow(10.0, random.uniform(-1, 3)) : 0;
  const Vector3d offset = away * random.direction();
  const double noise = random.below(2) ? scale * std::pow(10.0, random.uniform(-17, -12)) : 0;
  for (Vector3d& p : c.points) {
    p = scale * (turn * p) + offset;
    p += noise * random.direction();
  }
  c.radii.r = random.below(3) == 0 ? 0 : scale * std::pow(10.0, random.uniform(-3, 0));
  const double smallest = StpBv::smallestR(c.points, c.radii.r);
  switch (random.below(4)) {
    case 0:
      c.radii.R =
          smallest * (1 + std::pow(10.0, random.uniform(-9, -3))) + (smallest == c.radii.r ? scale : 0);
      break;
    case 1:
      c.radii.R = smallest + scale * std::pow(10.0, random.uniform(2, 6));
      break;
    default:
      c.radii.R = smallest + scale * std::pow(10.0, random.uniform(-2, 2));
      break;
  }
  return c;
}

CloudCase nearDegenerateCloud(Random& random) {
  CloudCase c;
  const auto anywhere = [&] {
    return Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  };
  const int kind = random.below(6), count = 4 + random.below(7);
  for (int i = 0; i < count; ++i) c.points.push_back(anywhere());
  const auto pick = [&]() -> const Vector3d& {
    return c.points[static_cast<std::size_t>(random.below(count))];
  };
  const auto off = [&](double least, double most) -> Vector3d {
    return std::pow(10.0, random.uniform(least, most)) * random.direction();
  };
  switch (kind) {
    case 0:  // points nearly on the lines through others
      for (int k = 1 + random.below(4); k > 0; --k) {
        const Vector3d a = pick(), b = pick();
        c.points.push_back(a + random.uniform(-0.5, 1.5) * (b - a) + off(-17, -7));
      }
      break;
    case 1:  // slivers: copies of points, moved along by little and off by far less
      for (int k = 1 + random.below(4); k > 0; --k) {
        const Vector3d a = pick(), b = pick();
        c.points.push_back(a + 1e-9 * std::pow(10.0, random.uniform(-3, 1)) * (b - a) + off(-18, -10));
      }
      break;
    case 2:  // vertices doubled
      for (int k = 1 + random.below(4); k > 0; --k) c.points.push_back(pick() + off(-8.5, -7.5));
      break;
    case 3:  // in one plane, to rounding or nearly
      for (Vector3d& p : c.points) p.z() = 0.3 * p.x() - 0.2 * p.y();
      if (random.below(2))
        for (Vector3d& p : c.points) p += off(-18, -9);
      break;
    case 4:  // on one sphere, some with their opposites and mirror images
      for (Vector3d& p : c.points) p.normalize();
      for (int k = random.below(4); k > 0; --k) {
        const Vector3d p = pick();
        c.points.push_back(random.below(2) ? Vector3d(-p) : Vector3d(p.x(), -p.y(), p.z()));
      }
      break;
    default:  // a box, and points on its sides and edges
      c.points = test::box(2, random.uniform(0.1, 2), random.uniform(0.001, 1));
      for (int k = random.below(6); k > 0; --k) {
        const Vector3d a = c.points[static_cast<std::size_t>(random.below(8))],
                       b = c.points[static_cast<std::size_t>(random.below(8))];
        c.points.push_back(a + random.uniform(0, 1) * (b - a));
      }
      break;
  }
  const double scale = std::pow(10.0, random.uniform(-2, 0));
  const Eigen::Matrix3d turn = random.below(2) ? random.rotation() : Eigen::Matrix3d::Identity();
  const Vector3d offset = random.below(2) ? Vector3d(scale * anywhere()) : Vector3d(Vector3d::Zero());
  const int rounding = random.below(4);
  for (Vector3d& p : c.points) {
    p = scale * (turn * p) + offset;
    if (rounding == 0) p = p.cast<float>().cast<double>();
    if (rounding == 1)  // millimetres in float32, scaled
      p = 0.001 * (1000 * p).cast<float>().cast<double>();
    if (rounding == 2)  // a text file with six decimals
      for (int k = 0; k < 3; ++k) p[k] = 1e-6 * std::round(1e6 * p[k]);
  }
  c.radii.r = random.below(4) == 0 ? 0 : 0.01;
  c.radii.R = random.below(2)
                  ? 10
                  : StpBv::smallestR(c.points, c.radii.r) * (1 + std::pow(10.0, random.uniform(-6, 3)));
  return c;
}

}  // namespace fcl_stpbv::fuzz
