// The distance of meshes and primitives, compared with all pairs of triangles in long double, and containment
// of one body in another.
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/sphere.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "fcl_stpbv/mesh/mesh_file.h"
#include "fcl_stpbv/report/mesh_distance.h"
#include "fcl_stpbv/report/mesh_fit.h"
#include "fcl_stpbv/robot/constraints.h"
#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/volume/tessellate.h"
#include "test/reference/robots.h"
#include "test/reference/shapes.h"
#include "test/reference/solids.h"
#include "test/reference/volume_files.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::report;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

namespace {

using V = Eigen::Matrix<long double, 3, 1>;
using T = std::array<V, 3>;

// Distance of a point and a triangle: to its plane if the foot lies inside, otherwise to its sides.
long double pointSegment(const V& p, const V& a, const V& b) {
  const V u = b - a;
  const long double l = u.squaredNorm();
  const long double t = l > 0 ? std::min(1.0L, std::max(0.0L, u.dot(p - a) / l)) : 0;
  return (p - a - t * u).norm();
}

long double pointTriangle(const V& p, const T& t) {
  const V n = (t[1] - t[0]).cross(t[2] - t[0]);
  long double least = 1e30L;
  bool inside = n.squaredNorm() > 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const V &a = t[k], &b = t[(k + 1) % 3];
    inside = inside && (b - a).cross(p - a).dot(n) >= 0;
    least = std::min(least, pointSegment(p, a, b));
  }
  return inside ? std::min(least, std::abs((p - t[0]).dot(n)) / n.norm()) : least;
}

// Distance of two segments: the ends of both against the other one, and the points where the common
// perpendicular meets both.
long double segmentSegment(const V& a, const V& b, const V& c, const V& d) {
  long double least =
      std::min({pointSegment(a, c, d), pointSegment(b, c, d), pointSegment(c, a, b), pointSegment(d, a, b)});
  const V u = b - a, v = d - c, w = u.cross(v);
  const long double det = w.squaredNorm();
  if (!(det > 0)) return least;
  const long double s = (c - a).cross(v).dot(w) / det, t = (c - a).cross(u).dot(w) / det;
  if (s >= 0 && s <= 1 && t >= 0 && t <= 1) least = std::min(least, std::abs((c - a).dot(w)) / w.norm());
  return least;
}

// Whether an edge goes through the inside of the other triangle.
bool crosses(const V& a, const V& b, const T& t) {
  const V n = (t[1] - t[0]).cross(t[2] - t[0]);
  const long double da = (a - t[0]).dot(n), db = (b - t[0]).dot(n);
  if (!(da * db <= 0) || da == db) return false;
  const V p = a + da / (da - db) * (b - a);
  for (std::size_t k = 0; k < 3; ++k)
    if ((t[(k + 1) % 3] - t[k]).cross(p - t[k]).dot(n) < 0) return false;
  return true;
}

long double triangles(const T& s, const T& t) {
  long double least = 1e30L;
  for (std::size_t i = 0; i < 3; ++i) {
    if (crosses(s[i], s[(i + 1) % 3], t) || crosses(t[i], t[(i + 1) % 3], s)) return 0;
    least = std::min({least, pointTriangle(s[i], t), pointTriangle(t[i], s)});
    for (std::size_t j = 0; j < 3; ++j)
      least = std::min(least, segmentSegment(s[i], s[(i + 1) % 3], t[j], t[(j + 1) % 3]));
  }
  return least;
}

// A triangle and a ball about it.
struct Placed {
  T corners;
  V centre;
  long double radius;
};

std::vector<Placed> placed(const TriangleMesh& mesh, const Eigen::Isometry3d& pose) {
  std::vector<Placed> all;
  for (const auto& triangle : mesh.triangles) {
    T t;
    for (std::size_t k = 0; k < 3; ++k)
      t[k] = pose.linear().cast<long double>() *
                 mesh.vertices[static_cast<std::size_t>(triangle[k])].cast<long double>() +
             pose.translation().cast<long double>();
    const V centre = (t[0] + t[1] + t[2]) / 3;
    all.push_back(
        {t, centre, std::max({(t[0] - centre).norm(), (t[1] - centre).norm(), (t[2] - centre).norm()})});
  }
  return all;
}

// Triangles whose balls are farther apart than two others are passed over.
long double bruteForce(const TriangleMesh& a, const Eigen::Isometry3d& poseA, const TriangleMesh& b,
                       const Eigen::Isometry3d& poseB) {
  const std::vector<Placed> first = placed(a, poseA), second = placed(b, poseB);
  long double least = 1e30L;
  for (const Placed& s : first)
    for (const Placed& t : second)
      if ((s.centre - t.centre).norm() <= least + s.radius + t.radius + 1e-15L)
        least = std::min(least, triangles(s.corners, t.corners));
  return least;
}

Body meshBody(const TriangleMesh& mesh, const std::string& file) {
  saveMesh(file, mesh);
  Body body;
  body.file = file;
  return body;
}

// A grid of `around` times `along` points, closed in both directions like a tyre. `at` gives their positions.
TriangleMesh grid(int around, int along, const std::function<Vector3d(double, double)>& at) {
  constexpr double kTurn = 6.283185307179586;
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < along; ++j) mesh.vertices.push_back(at(kTurn * i / around, kTurn * j / along));
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < along; ++j) {
      const int a = i * along + j, b = (i + 1) % around * along + j, c = i * along + (j + 1) % along,
                d = (i + 1) % around * along + (j + 1) % along;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

TriangleMesh tyre(double large, double small) {
  return grid(24, 12, [=](double u, double v) {
    const double ring = large + small * std::cos(v);
    return Vector3d(ring * std::cos(u), ring * std::sin(u), small * std::sin(v));
  });
}

TriangleMesh ball(double radius, const Vector3d& centre = Vector3d::Zero()) {
  const auto volume = StpBv::build({centre}, {radius, 2 * radius});
  return tessellate(*volume, 0.4);
}

// A closed body with dents, and a soup of long thin triangles.
TriangleMesh dented(Random& random) {
  TriangleMesh mesh = ball(0.1);
  for (Vector3d& v : mesh.vertices) v *= random.uniform(0.5, 1.2);
  return mesh;
}

TriangleMesh slivers(Random& random) {
  TriangleMesh mesh;
  for (int k = 0; k < 40; ++k) {
    const Vector3d a = 0.1 * random.direction(), along = 0.1 * random.direction();
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, a + along, a + 0.5 * along + 1e-7 * random.direction()});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

Eigen::Isometry3d shifted(double x, double y = 0, double z = 0) {
  return pose(Eigen::Matrix3d::Identity(), Vector3d(x, y, z));
}

bool meet(const MeshDistance& d) { return d.upper == 0; }

}  // namespace

TEST_CASE("the distance of two meshes is that of their nearest triangles") {
  const TemporaryFolder folder;
  Random random(31);
  int apart = 0, meeting = 0;
  for (int round = 0; round < 24; ++round) {
    const Body one = meshBody(round % 3 == 0 ? slivers(random) : dented(random), folder / "a.obj");
    const Body two = meshBody(round % 4 == 1   ? slivers(random)
                              : round % 4 == 2 ? tyre(0.1, 0.03)
                                               : dented(random),
                              folder / "b.obj");
    const ExactBody a(one), b(two);
    const TriangleMesh meshA = loadMesh(one.file), meshB = loadMesh(two.file);  // with the file's rounding
    for (int k = 0; k < 3; ++k) {
      const Eigen::Isometry3d poseA = pose(random.rotation(), random.uniform(0, 1) * random.direction());
      const Eigen::Isometry3d poseB =
          pose(random.rotation(), poseA.translation() + random.uniform(0.1, 0.4) * random.direction());
      const double truth = static_cast<double>(bruteForce(meshA, poseA, meshB, poseB));
      const MeshDistance d = meshDistance(a, poseA, b, poseB);
      INFO("round " << round << ", truth " << truth << ", found " << d.lower << " to " << d.upper);
      if (truth == 0) {
        CHECK(meet(d));
        ++meeting;
      } else if (!meet(d)) {  // the next test is about containment
        CHECK(d.upper - d.lower <= 1.01e-7);
        CHECK(d.lower <= truth + 1e-13);  // rounding of coordinates of 1 m in either
        CHECK(d.upper >= truth - 1e-13);
        const MeshDistance with = meshDistance(a, poseA, b, poseB, 0.9 * truth);
        CHECK(std::abs(with.upper - truth) <= 1.01e-7);
        ++apart;
      }
    }
  }
  CHECK(apart > 20);
  CHECK(meeting > 10);
}

TEST_CASE(
    "a mesh inside a closed one meets it, in a tyre's hole it does not, and mirrored ones are no different") {
  const TemporaryFolder folder;
  const Body small = meshBody(ball(0.02), folder / "small.obj"),
             ring = meshBody(tyre(0.1, 0.04), folder / "ring.obj");
  for (const double mirror : {1.0, -1.0}) {
    Body turned = ring;
    turned.scale = Vector3d(mirror, 1, 1);
    const ExactBody inner(small), outer(turned);
    CHECK(outer.closed());
    CHECK(meet(meshDistance(inner, shifted(0.1), outer, shifted(0))));
    CHECK(meet(meshDistance(outer, shifted(0), inner, shifted(0.1))));
    const MeshDistance hole = meshDistance(inner, shifted(0), outer, shifted(0));
    CHECK(hole.lower > 0.03);
    CHECK(hole.upper < 0.05);
    CHECK(outer.volume() ==
          Approx(2 * 9.8696044 * 0.1 * 0.04 * 0.04).epsilon(0.08));  // less because of its flat sides
  }
}

TEST_CASE("one part of many inside is enough, and an open mesh is told from a closed one") {
  const TemporaryFolder folder;
  TriangleMesh two = ball(0.01, Vector3d(1, 0, 0));
  const TriangleMesh other = ball(0.01, Vector3d(0.1, 0, 0));
  for (const auto& t : other.triangles) {
    std::array<int, 3> moved = t;
    for (int& v : moved) v += static_cast<int>(two.vertices.size());
    two.triangles.push_back(moved);
  }
  two.vertices.insert(two.vertices.end(), other.vertices.begin(), other.vertices.end());
  TriangleMesh bowl = tyre(0.1, 0.04);
  const Body parts = meshBody(two, folder / "two.obj"), ring = meshBody(bowl, folder / "ring.obj");
  bowl.triangles.resize(bowl.triangles.size() - 1);
  const Body holed = meshBody(bowl, folder / "holed.obj");
  CHECK(ExactBody(parts).partPoints().size() == 2);
  CHECK(meet(meshDistance(ExactBody(parts), shifted(0), ExactBody(ring), shifted(0))));
  CHECK_FALSE(ExactBody(holed).closed());
  CHECK(std::isnan(ExactBody(holed).volume()));
  // Meshes that are not closed.
  CHECK(meet(meshDistance(ExactBody(parts), shifted(0), ExactBody(holed), shifted(0))));
}

TEST_CASE("primitives count as they are, solid, and points without triangles as their hull") {
  const TemporaryFolder folder;
  const Body ring = meshBody(tyre(0.1, 0.04), folder / "ring.obj");
  Body cube, sphere, points;
  cube.geometry = std::make_shared<fcl::Boxd>(0.2, 0.2, 0.2);
  sphere.geometry = std::make_shared<fcl::Sphered>(0.02);
  for (Body* body : {&cube, &sphere}) body->geometry->computeLocalAABB();
  put(folder / "points-ch.txt", "3\n4\n0 0 0\n0.1 0 0\n0 0.1 0\n0 0 0.1\n");
  points.file = folder / "points-ch.txt";
  const ExactBody tyreBody(ring), box(cube), ballBody(sphere), hull(points);
  // The tyre's outermost corners are exactly at 0.14 m.
  const MeshDistance beside = meshDistance(tyreBody, shifted(0), box, shifted(0.5));
  CHECK(beside.lower <= 0.26 + 1e-8);  // the file has single precision
  CHECK(beside.upper >= 0.26 - 1e-8);
  CHECK(beside.upper - beside.lower <= 1.01e-7);
  CHECK(meet(meshDistance(ballBody, shifted(0.1), tyreBody, shifted(0))));
  CHECK_FALSE(meet(meshDistance(ballBody, shifted(0), tyreBody, shifted(0))));
  CHECK(meet(meshDistance(ballBody, shifted(0), box, shifted(0))));
  const MeshDistance pair = meshDistance(ballBody, shifted(0.2), box, shifted(0));
  CHECK(pair.upper == Approx(0.08).margin(1.01e-7));
  CHECK(meshDistance(hull, shifted(0.15), box, shifted(0)).upper == Approx(0.05).margin(1.01e-7));
  CHECK(hull.solid() == nullptr);
}

TEST_CASE("the rows of constraints bound the distance of the meshes, as the report does") {
  const TemporaryFolder folder;
  Random random(5);
  saveMesh(folder / "tyre.obj", tyre(0.1, 0.03));
  saveMesh(folder / "dented.obj", dented(random));
  const std::string axis = "<axis xyz=\"1 0.1 0.2\"/>";
  put(folder / "r.urdf",
      robot(link("a", "<mesh filename=\"tyre.obj\"/>") + link("b", "<mesh filename=\"dented.obj\"/>") +
            link("c", "<box size=\"0.1 0.1 0.1\"/>") + joint("j", "prismatic", "a", "b", axis) +
            joint("k", "prismatic", "b", "c", axis)));
  const auto model = std::make_shared<const RobotModel>(loadUrdf(folder / "r.urdf"));
  const auto kinematics = std::make_shared<const Kinematics>(model);
  GeometryOptions options;
  options.cacheFolder = "";
  RobotGeometry bodies = loadGeometry(*model, options);
  // The box stands in the world too, as a body of a scene and as a plain object of FCL.
  const std::vector<CheckedPair> pairs{{0, 1}, {0, 2}, {1, 2}, {1, 0, true}, {1, 1, true}};
  ConstraintOptions rows;
  rows.obstacles = obstaclesOf(model, bodies);
  const Obstacle plain("plain", bodies.bodies[2].geometry);
  rows.obstacles = {rows.obstacles[2], plain};
  Eigen::VectorXd d(5);
  const Eigen::Vector2d apart(0.9, 0.9);
  CollisionConstraints unmeasured(kinematics, std::make_shared<const RobotGeometry>(bodies), pairs, rows);
  unmeasured.evaluate(apart, d);
  CHECK(std::isnan(unmeasured.answer(0).meshDistanceMost));

  measureExcess(bodies, 2);
  rows.obstacles = {obstaclesOf(model, bodies)[2], plain};
  const auto geometry = std::make_shared<const RobotGeometry>(bodies);
  CollisionConstraints constraints(kinematics, geometry, pairs, rows);
  detail::VolumeCache none("");
  std::vector<ExactBody> exact;
  std::vector<double> excess;
  for (const Body& body : bodies.bodies) exact.emplace_back(body);
  for (const Body& body : bodies.bodies)
    excess.push_back(meshFit(
                         body, [&]() -> const ExactBody& { return exact[excess.size()]; }, none)
                         .volumeExcess);
  CHECK(excess[0] > 0.03);  // the hull closes the tyre's hole
  int seen = 0;
  for (int k = 0; k < 60; ++k) {
    const Eigen::Vector2d q = k == 0 ? apart : Eigen::Vector2d(random.uniform(-1, 1), random.uniform(-1, 1));
    constraints.evaluate(q, d);
    for (int row = 0; row < 5; ++row) {
      const RowAnswer answer = constraints.answer(row);
      const CheckedPair& pair = pairs[static_cast<std::size_t>(row)];
      const auto first = static_cast<std::size_t>(pair.body),
                 second = pair.obstacle ? 2 : static_cast<std::size_t>(pair.other);
      INFO("row " << row << ", q " << q.transpose() << ", d " << answer.distance);
      if (!(answer.distance > 0)) {
        CHECK(std::isnan(answer.meshDistanceMost));
        continue;
      }
      CHECK(answer.meshDistanceMost == answer.upper + (excess[first] + excess[second]));
      const auto pose = [&](std::size_t body) {
        return constraints.state().link[static_cast<std::size_t>(bodies.bodies[body].link)] *
               bodies.bodies[body].pose;
      };
      const Eigen::Isometry3d there =
          pair.obstacle ? rows.obstacles[static_cast<std::size_t>(pair.other)].pose() : pose(second);
      const MeshDistance truth = meshDistance(exact[first], pose(first), exact[second], there);
      CHECK(answer.lower <= truth.upper + 1e-12);
      CHECK(truth.lower <= answer.meshDistanceMost + 1e-12);
      ++seen;
    }
  }
  CHECK(seen > 100);
}

TEST_CASE("a mesh that was saved after its body was made is not measured") {
  const TemporaryFolder folder;
  saveMesh(folder / "m.obj", lShape());
  put(folder / "r.urdf", robot(link("a", "<mesh filename=\"m.obj\"/>")));
  const RobotGeometry geometry = load({"", folder / "r.urdf", "", {}}).geometry;
  CHECK(ExactBody(geometry.bodies[0]).volume() > 0);
  saveMesh(folder / "m.obj", boxMesh({0, 0, 0}, {0.1, 0.1, 0.1}));
  CHECK_THROWS_WITH(ExactBody(geometry.bodies[0]), Catch::Contains("changed while it was read; run again"));
}
