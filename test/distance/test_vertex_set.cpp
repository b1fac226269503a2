// The loops over a polytope's vertices, compared with plain loops, for every remainder of the vertex count
// modulo four.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "fcl_stpbv/convex/shape.h"
#include "fcl_stpbv/convex/vertex_cap.h"
#include "fcl_stpbv/convex/vertex_set.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

TEST_CASE("vertices four at a time: their middle, the furthest from a point and along a direction") {
  Random random(1);
  for (int count = 1; count <= 41; ++count)
    for (int i = 0; i < 50; ++i) {
      std::vector<Vector3d> vertices;
      for (int k = 0; k < count; ++k) {
        // Many of them are on a grid, so that several are equally far.
        Vector3d v = random.uniform(0, 1) * random.direction();
        if (i % 2 == 0) v = (2 * v).array().round();
        vertices.push_back(v);
      }
      const Vector3d d = i % 4 == 0 ? Vector3d::Unit(i % 3) : random.direction(), point = random.direction();
      Vector3d sum(0, 0, 0);
      double reach = 0, most = -1e9;
      for (const Vector3d& v : vertices) {
        sum += v;
        reach = std::max(reach, (v - point).norm());
        most = std::max(most, d.dot(v));
      }
      CAPTURE(count, i);
      const Spread spread = spreadAbout(point, vertices.data(), count);
      CHECK((spread.middle - sum / count).norm() <= 1e-15);
      CHECK(spread.reach == Approx(reach).margin(1e-15).epsilon(0));
      const int best = furthestAlong(d, vertices.data(), count);
      REQUIRE((best >= 0 && best < count));
      CHECK(d.dot(vertices[static_cast<std::size_t>(best)]) >= most - 2e-16);
      std::vector<int> high(static_cast<std::size_t>(count) + 1, -1), expected;
      const double least = most - 0.5;
      for (int k = 0; k < count; ++k)
        if (d.dot(vertices[static_cast<std::size_t>(k)]) >= least) expected.push_back(k);
      const bool told = std::none_of(vertices.begin(), vertices.end(),
                                     [&](const Vector3d& v) { return std::abs(d.dot(v) - least) < 1e-15; });
      for (const int room : {count, 2}) {
        const int many = fromHeight(least, d, vertices.data(), count, high.data(), room);
        if (!told) continue;  // by rounding either way
        REQUIRE(many == static_cast<int>(expected.size()));
        const auto written = std::min<std::size_t>(expected.size(), static_cast<std::size_t>(room));
        CHECK(std::equal(expected.begin(), expected.begin() + static_cast<long>(written), high.begin()));
        CHECK(high[static_cast<std::size_t>(count)] == -1);
      }
      if (i % 4 == 0) {  // heights without rounding: the first of the equal ones must be found
        const auto first = std::find_if(vertices.begin(), vertices.end(),
                                        [&](const Vector3d& v) { return d.dot(v) == most; });
        CHECK(best == first - vertices.begin());
      }
    }
}

TEST_CASE("the given mean of a polytope changes neither its ball nor whether it is valid") {
  constexpr double kInf = std::numeric_limits<double>::infinity(),
                   kNaN = std::numeric_limits<double>::quiet_NaN();
  Random random(3);
  for (const int count : {1, 3, 4, 5, 8, 13, 162})
    for (const double away : {0.0, 1e6}) {
      Cloud vertices;
      Vector3d mean(0, 0, 0);
      for (int k = 0; k < count; ++k) {
        vertices.push_back(random.direction() + Vector3d(away, 0, 0));
        mean += vertices.back() / count;
      }
      const double rounding = 1e-15 * (count + 10) * (1 + away);
      const Vector3d shift(1e-13, 0, 0), farther(1e-3, 0, 0);
      for (const Vector3d& said : {mean, Vector3d(mean + shift), Vector3d(mean + farther), Vector3d(0, 0, 0),
                                   Vector3d(1e300, 0, 0), Vector3d(kNaN, 0, 0), Vector3d(0, kInf, 0)}) {
        const Shape shape = Shape::polytopeOf(vertices.data(), count, said);
        CAPTURE(count, away, said.transpose());
        CHECK(shape.valid());
        CHECK((shape.centre - mean).norm() <= rounding);
        double reach = 0;
        for (const Vector3d& v : vertices) reach = std::max(reach, (v - shape.centre).norm());
        CHECK(shape.reach >= reach - 1e-15 * (1 + reach));
        CHECK(shape.reach <= reach + 1e-11);
        // A vertex with a coordinate that is not finite, at any index.
        for (int k = 0; k < count; k += 1 + count / 7)
          for (const double wrong : {kNaN, kInf, -kInf}) {
            Cloud broken = vertices;
            broken[static_cast<std::size_t>(k)][k % 3] = wrong;
            CHECK(!Shape::polytopeOf(broken.data(), count, said).valid());
          }
      }
    }
}

TEST_CASE("a cap's vertex is as far along a direction as any, whatever was asked for before") {
  Random random(2);
  Cloud grid, doubled = geodesicSphere(1, 2);
  for (int k = 0; k < 1800; ++k) grid.push_back({0.1 * (k % 30), 0.1 * (k / 30 % 30), k < 900 ? 0.0 : 1e-3});
  for (const Vector3d& v : geodesicSphere(1, 2)) doubled.push_back(v + 1e-15 * random.direction());
  const std::vector<Cloud> bodies{geodesicSphere(1, 3), cylinder(1, 2, 200), grid, doubled,
                                  randomHull(500, {1, 1e-3, 1}, 4)};
  int known = 0;
  for (const Cloud& body : bodies)
    for (const double scale : {1e-6, 1.0, 1e6})
      for (const double away : {0.0, 1e3}) {
        Cloud vertices;
        double size = 0;
        for (const Vector3d& v : body) vertices.push_back(scale * (v + away * Vector3d(1, -1, 1)));
        for (const Vector3d& v : vertices) size = std::max(size, v.lpNorm<Eigen::Infinity>());
        const int count = static_cast<int>(vertices.size());
        VertexCap cap;
        Vector3d d = random.direction();
        for (int i = 0; i < 300; ++i) {
          d += std::pow(10.0, random.uniform(-9, 0)) * random.direction();
          if (i % 50 == 0) d = Vector3d::Unit(i / 50 % 3);
          d.normalize();
          const double length = i % 3 == 0 ? 1.0 : std::pow(10.0, random.uniform(-3, 3));
          const Vector3d found = cap.furthest(length * d, vertices.data(), count);
          double most = -std::numeric_limits<double>::infinity();
          for (const Vector3d& v : vertices) most = std::max(most, d.dot(v));
          CAPTURE(count, scale, away, i);
          CHECK(std::find(vertices.begin(), vertices.end(), found) != vertices.end());
          // For each of the two: rounding of three products and two sums.
          CHECK(d.dot(found) >= most - 2e-15 * size);
          // The candidates hold the furthest vertex along every direction up to the chord.
          const double chord = random.uniform(0.0, 0.1);
          const VertexList list = cap.candidates(d, chord, vertices.data(), count);
          known += list.count < count;
          const Vector3d e = (d + 0.99 * chord * random.direction()).normalized();
          if ((e - d).norm() > chord) continue;
          const auto along = [&](const Vector3d& v, const Vector3d& w) { return e.dot(v) < e.dot(w); };
          CHECK(e.dot(*std::max_element(list.first, list.first + list.count, along)) >=
                e.dot(*std::max_element(vertices.begin(), vertices.end(), along)) - 2e-15 * size);
        }
      }
  CHECK(known > 1000);  // lists shorter than the whole polytope
}
