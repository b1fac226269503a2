// Extreme and invalid poses, and polyhedra from degenerate meshes.
#include <cmath>
#include <cstdio>
#include <limits>

#include "test/reference/stability/situation.h"

namespace fcl_stpbv::stability {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::Random;

namespace {

struct Shape {
  const char* name;
  Cloud cloud;
};

std::vector<Shape> shapes(std::uint64_t seed) {
  return {{"boxes", test::box(0.3, 0.2, 0.25)},
          {"drums", test::cylinder(0.1, 0.2)},
          {"hulls", test::randomHull(30, {0.2, 0.15, 0.1}, seed)}};
}

}  // namespace

void addPoses(std::vector<Situation>& all, std::uint64_t seed) {
  Random random(seed + 4);
  const StpBvOptions usual{0.01, 10.0};
  for (const Shape& shape : shapes(seed)) {
    const auto body = makeBody(shape.cloud, usual);
    const auto blank = [&](const std::string& group, const std::string& name) {
      Situation s;
      s.group = group;
      s.name = shape.name + name;
      s.a = s.b = body;
      return s;
    };
    for (const double away : {1e3, 1e6}) {
      Situation s = blank("1e3 and 1e6 m from the origin", formatted(", %.0e m", away));
      for (int i = 0; i < 8; ++i) {
        const Vector3d offset = away * random.direction();
        const double apart = i < 4 ? 0.6 : 0.36;
        s.placements.push_back({test::pose(random.rotation(), offset),
                                test::pose(random.rotation(), offset + apart * random.direction())});
      }
      all.push_back(std::move(s));
    }
    Situation far = blank("1e3 and 1e6 m from the origin", ", 1e6 m from each other");
    for (int i = 0; i < 3; ++i)
      far.placements.push_back({test::pose(random.rotation(), {0, 0, 0}),
                                test::pose(random.rotation(), 1e6 * random.direction())});
    all.push_back(std::move(far));
    for (const double error : {1e-12, 1e-9, 1e-6}) {
      Situation s = blank("rotation matrices off by 1e-12 to 1e-6", formatted(", %.0e", error));
      for (int i = 0; i < 6; ++i) {
        Placement at{test::pose(random.rotation(), {0, 0, 0}),
                     test::pose(random.rotation(), 0.6 * random.direction())};
        for (Isometry3d* p : {&at.a, &at.b})
          for (int k = 0; k < 9; ++k) p->linear()(k / 3, k % 3) += error * random.uniform(-1, 1);
        s.placements.push_back(at);
      }
      // A matrix that is off by e moves points by up to 3 e of their distance. The rotation that is meant is
      // uncertain by as much.
      s.slack = 10 * error;
      all.push_back(std::move(s));
    }
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    for (const double poison : {nan, inf}) {
      Situation s = blank("poses with NaN or infinity", std::isnan(poison) ? ", NaN" : ", infinity");
      s.expected = Expected::refusal;
      for (int i = 0; i < 4; ++i) {
        Placement at{test::pose(Matrix3d::Identity(), {0, 0, 0}), test::pose(random.rotation(), {0.5, 0, 0})};
        Isometry3d& p = i % 2 ? at.a : at.b;
        (i < 2 ? p.translation()[1] : p.linear()(1, 2)) = poison;
        s.placements.push_back(at);
      }
      all.push_back(std::move(s));
    }
  }
}

void addMeshes(std::vector<Situation>& all, std::uint64_t seed) {
  Random random(seed + 5);
  const StpBvOptions usual{0.01, 10.0};
  const Cloud box = test::box(0.3, 0.2, 0.25);
  // Corner i has positive x, y, z if bits 1, 2, 4 of i are set. Faces are counter-clockwise from outside.
  const std::vector<int> quads{4, 0, 2, 3, 1, 4, 4, 5, 7, 6, 4, 0, 1, 5, 4,
                               4, 2, 6, 7, 3, 4, 0, 4, 6, 2, 4, 1, 3, 7, 5};
  std::vector<int> inside = quads, holed(quads.begin(), quads.end() - 10), zero = quads;
  for (std::size_t f = 0; f < inside.size(); f += 5) std::swap(inside[f + 2], inside[f + 4]);
  for (const int i : {0, 1, 1, 2, 2, 2, 5, 7, 5})  // triangles of zero area in addition to the good faces
    zero.push_back(i);
  zero.insert(zero.end() - 9, 3);
  zero.insert(zero.end() - 6, 3);
  zero.insert(zero.end() - 3, 3);
  // For more than 32 vertices FCL climbs over the faces it is given.
  Cloud bigDrum = test::cylinder(0.15, 0.3, 40);
  std::vector<int> open;  // only its side; the lids are missing
  for (int i = 0; i < 40; ++i) {
    const int j = (i + 1) % 40;
    open.insert(open.end(), {4, 2 * i, 2 * j, 2 * j + 1, 2 * i + 1});
  }
  struct Mesh {
    const char* name;
    Cloud cloud;
    std::vector<int> facets;
  };
  const std::vector<Mesh> meshes{
      {"a box with triangles of zero area", box, zero},
      {"a box with two faces missing", box, holed},
      {"a box turned inside out", box, inside},
      {"a single triangle", {{0.2, 0, 0}, {-0.1, 0.2, 0}, {-0.1, -0.2, 0}}, {3, 0, 1, 2}},
      {"a drum without lids", bigDrum, open}};
  const auto other = makeBody(test::box(0.2, 0.25, 0.3), usual);
  for (const Mesh& mesh : meshes) {
    Situation s;
    s.group = "degenerate meshes";
    s.name = mesh.name;
    s.a = makeBody(mesh.cloud, usual, mesh.facets);
    s.b = other;
    for (int i = 0; i < 8; ++i)
      s.placements.push_back({test::pose(random.rotation(), {0, 0, 0}),
                              test::pose(random.rotation(), (i % 2 ? 0.6 : 0.45) * random.direction())});
    all.push_back(std::move(s));
  }
}

}  // namespace fcl_stpbv::stability
