// Parallel and touching features: faces, edges and vertices over each other at gaps and depths from 1e-15 m
// to 1e-3 m, and slides and rocks through these.
#include <cmath>

#include "test/reference/stability/situation.h"

namespace fcl_stpbv::stability {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using test::Random;
using test::rotationBetween;

namespace {

constexpr StpBvOptions kUsual{0.01, 10.0}, kBare{0.0, 10.0};

Matrix3d about(const Vector3d& axis, double angle) {
  return AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

/// A body with the tested feature at its top, and one with it at its bottom. touching() is the distance along
/// z at which the two polyhedra touch.
struct Arrangement {
  const char* name;
  Cloud below, above;
  Matrix3d turnBelow, turnAbove;
  Vector3d lateral;  ///< position of the upper body across z

  double touching() const {
    double top = -HUGE_VAL, bottom = HUGE_VAL;
    for (const Vector3d& p : below) top = std::max(top, (turnBelow * p).z());
    for (const Vector3d& p : above) bottom = std::min(bottom, (turnAbove * p).z());
    return top - bottom;
  }
};

std::vector<Arrangement> arrangements() {
  const Cloud cube = test::box(0.2, 0.2, 0.2), slab = test::box(0.5, 0.3, 0.1),
              drum = test::cylinder(0.1, 0.2);
  const Matrix3d flat = Matrix3d::Identity();
  const Matrix3d onEdge = about(Vector3d::UnitY(), M_PI / 4);
  const Matrix3d onEdgeX = about(Vector3d::UnitX(), M_PI / 4);
  const Matrix3d onCorner = test::rotationBetween(Vector3d(1, 1, 1), -Vector3d::UnitZ());
  const Matrix3d upCorner = test::rotationBetween(Vector3d(1, 1, 1), Vector3d::UnitZ());
  const Vector3d aside(0.013, 0.007, 0), centred(0, 0, 0);
  return {{"face over face", slab, cube, flat, flat, aside},
          {"face over face, centred", slab, cube, flat, flat, centred},
          {"equal faces, in line", cube, cube, flat, flat, centred},
          {"faces over rims", cube, cube, flat, flat, Vector3d(0.2, 0, 0)},
          {"round face over round face", drum, drum, flat, flat, aside},
          {"edge over face", slab, cube, flat, onEdge, aside},
          {"edge over rim", cube, cube, flat, onEdge, Vector3d(0.1, 0, 0)},
          {"edge along edge", cube, cube, onEdge, onEdge, Vector3d(0, 0.013, 0)},
          {"edge along edge, in line", cube, cube, onEdge, onEdge, centred},
          {"edge across edge", cube, cube, onEdge, onEdgeX, aside},
          {"vertex over face", slab, cube, flat, onCorner, aside},
          {"vertex over edge", cube, cube, onEdge, onCorner, Vector3d(0, 0.007, 0)},
          {"vertex over vertex", cube, cube, upCorner, onCorner, centred},
          {"round side over face", slab, drum, flat, about(Vector3d::UnitX(), M_PI / 2), aside}};
}

/// The pair with its polyhedra `gap` apart. Both are turned together, so that no axis of the world is
/// special.
Placement placed(const Arrangement& arrangement, double gap, const Matrix3d& world) {
  const Vector3d up = arrangement.lateral + Vector3d(0, 0, arrangement.touching() + gap);
  return {test::pose(world * arrangement.turnBelow, {0, 0, 0}),
          test::pose(world * arrangement.turnAbove, world * up)};
}

/// Group of the table for an arrangement, by its two features.
std::string groupOf(const Arrangement& arrangement) {
  const std::string name = arrangement.name;
  if (name.rfind("vertex", 0) == 0) return "vertex over vertex, edge, face";
  if (name == "edge over face" || name == "edge over rim" || name == "round side over face")
    return "edge parallel to face";
  if (name.rfind("edge", 0) == 0) return "edges, parallel and crossed";
  return "parallel faces";
}

}  // namespace

void addContacts(std::vector<Situation>& all, std::uint64_t seed) {
  Random random(seed);
  for (const Arrangement& arrangement : arrangements()) {
    const Matrix3d turned = random.rotation();
    for (const bool bare : {false, true}) {
      const StpBvOptions radii = bare ? kBare : kUsual;
      const auto a = makeBody(arrangement.below, radii), b = makeBody(arrangement.above, radii);
      const std::string suffix = bare ? ", r = 0" : "";
      const auto add = [&](const std::string& group, const std::string& name,
                           std::vector<Placement> placements) {
        Situation s;
        s.group = group;
        s.name = name;
        s.a = a;
        s.b = b;
        s.placements = std::move(placements);
        s.towards = s.placements[0].b.translation();
        all.push_back(std::move(s));
      };
      const Matrix3d straight = Matrix3d::Identity();
      add(groupOf(arrangement), arrangement.name + suffix,
          {placed(arrangement, 0.05, straight), placed(arrangement, 0.05, turned),
           placed(arrangement, 0.3, turned)});
      add("exact touch", arrangement.name + suffix,
          {placed(arrangement, 0, straight), placed(arrangement, 0, turned)});
      std::vector<Placement> gaps, depths;
      for (int exponent = -15; exponent <= -3; exponent += 3) {
        gaps.push_back(placed(arrangement, std::pow(10.0, exponent), exponent % 2 ? straight : turned));
        depths.push_back(placed(arrangement, -std::pow(10.0, exponent), exponent % 2 ? turned : straight));
      }
      add("gaps 1e-15 to 1e-3 m", arrangement.name + suffix, std::move(gaps));
      add("depths 1e-15 to 1e-3 m", arrangement.name + suffix, std::move(depths));
    }
  }
}

void addMotions(std::vector<Situation>& all, std::uint64_t seed) {
  Random random(seed + 1);
  for (const Arrangement& arrangement : arrangements()) {
    const auto a = makeBody(arrangement.below, kUsual), b = makeBody(arrangement.above, kUsual);
    const Matrix3d world = random.rotation();
    for (const double step : {1e-9, 1e-7, 1e-5, 1e-3}) {
      constexpr int kSteps = 40;
      const Placement middle = placed(arrangement, 0.05, world);
      const auto add = [&](const char* group, const std::string& name, const auto& move) {
        Situation s;
        s.group = group;
        s.name = std::string(arrangement.name) + ", " + name + formatted(", steps of %.0e", step);
        s.a = a;
        s.b = b;
        s.isPath = true;
        s.towards = middle.b.translation();
        for (int k = -kSteps / 2; k <= kSteps / 2; ++k) {
          Placement at = middle;
          move(at.b, (k + 0.3) * step);
          s.placements.push_back(at);
        }
        all.push_back(std::move(s));
      };
      const Vector3d along = world * Vector3d(0.8, 0.6, 0), across = world * Vector3d(0.28, 0.96, 0);
      add("slides", "sliding", [&](Isometry3d& p, double x) { p.translation() += x * along; });
      add("rocks", "rocking", [&](Isometry3d& p, double x) { p.linear() = about(across, x) * p.linear(); });
    }
    // A motion through contact, along the normal.
    Situation s;
    s.group = "slides";
    s.name = std::string(arrangement.name) + ", approaching through contact";
    s.a = a;
    s.b = b;
    s.isPath = true;
    for (int k = 20; k >= -20; --k) s.placements.push_back(placed(arrangement, 4e-4 * k + 1e-13, world));
    s.towards = s.placements[0].b.translation();
    all.push_back(std::move(s));
  }
}

}  // namespace fcl_stpbv::stability
