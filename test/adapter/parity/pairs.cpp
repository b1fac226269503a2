// Compares fcl::distance and fcl::collide with the library's functions, field by field.
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/adapter/collide.h"
#include "test/adapter/parity/questions.h"

namespace fcl_stpbv::parity {

using namespace test;
using Eigen::Vector3d;
using Pieces = std::vector<Piece>;

namespace {

constexpr double kFine = 1e-6;  // m: FCL's own default tolerance
// m: points of an iteration that stops at kFine are off by the square root of kFine.
constexpr double kCoarse = 1e-3;
constexpr double kDepth = 1e-4;  // m: FCL's EPA stops between these two
constexpr double kOurs = 1e-9;   // m: largest error of the library's bounded answers in these tests

bool nearestElement(const Type& type, const Pieces& here, const Pieces& there, std::intptr_t id, double least,
                    double within) {
  if (!type.elements) return id == -1;
  const Pieces named = only(here, id);
  return named.size() == 1 && truthOf(named, there).distance <= least + within;
}

bool goodPoints(const Pieces& a, const Pieces& b, const fcl::DistanceResultd& result, double within) {
  const Vector3d &p = result.nearest_points[0], &q = result.nearest_points[1];
  return std::abs((q - p).norm() - std::abs(result.min_distance)) <= within && distanceOf(a, p) <= within &&
         distanceOf(b, q) <= within;
}

/// Compares a depth with the least depth over many normals. The library's depth must separate the bodies
/// along its normal and must not be larger than that.
void checkDepth(const Pieces& a, const Pieces& b, double depth, const Vector3d& n, Findings& found) {
  found.ours("moving apart by the depth does not separate", gapAlong(a, b, n) < -depth - kOurs);
  found.ours("there is a smaller depth", -widestGap(a, b) < depth - kFine);
}

void askDistance(bool isSigned, const Type& ta, const Type& tb, int i, Random& random, Findings& found) {
  const Placement at = placementOf(random, i);
  const DistanceAnswer known = distance(*ta.geometry, at.a, *tb.geometry, at.b);
  fcl::DistanceResultd ours;
  const fcl::DistanceRequestd request(true, isSigned);
  const double answered =
      fcl_stpbv::distance(ta.geometry.get(), at.a, tb.geometry.get(), at.b, request, ours);
  const Pieces a = ta.pieces(at.a), b = tb.pieces(at.b);
  const bool answers = known.status != DistanceStatus::invalid;
  if (!answers) found.unanswered();
  const Truth truth = truthOf(a, b);
  const bool shapes = !ta.elements && !tb.elements && !ta.unbounded() && !tb.unbounded();
  if (answers) {
    found.ours("the return value is not the distance", answered != ours.min_distance);
    found.ours("apart or not", (ours.min_distance > 0) == truth.overlap && std::abs(truth.distance) > kOurs);
    found.ours("distance", !truth.overlap && std::abs(ours.min_distance - truth.distance) > kOurs);
    found.ours("points", !truth.overlap && !goodPoints(a, b, ours, kOurs));
    found.ours("b1, b2", !truth.overlap && (!nearestElement(ta, a, b, ours.b1, truth.distance, kOurs) ||
                                            !nearestElement(tb, b, a, ours.b2, truth.distance, kOurs)));
    found.ours("o1, o2", ours.o1 != ta.geometry.get() || ours.o2 != tb.geometry.get());
    if (truth.overlap && shapes) checkDepth(a, b, -known.distance, known.normal, found);
  }

  fcl::DistanceResultd theirs;
  for (Vector3d& p : theirs.nearest_points) p.setConstant(NAN);
  fcl::distance(ta.geometry.get(), at.a, tb.geometry.get(), at.b, request, theirs);
  const double d = theirs.min_distance;
  if (d == std::numeric_limits<double>::max()) return found.theirs('n', true);
  if (std::abs(truth.distance) > kFine || truth.overlap) found.theirs('s', (d > 0) == truth.overlap);
  if (truth.overlap || !(d > 0)) {
    if (isSigned && truth.overlap && shapes && !(d > 0))
      found.theirs('d', std::abs(-d + known.distance) > kDepth);
    return;
  }
  found.theirs('d', std::abs(d - truth.distance) > kFine);
  found.theirs('p', !goodPoints(a, b, theirs, kCoarse));
  found.theirs('b', !nearestElement(ta, a, b, theirs.b1, truth.distance, kCoarse) ||
                        !nearestElement(tb, b, a, theirs.b2, truth.distance, kCoarse));
  found.theirs('o', theirs.o1 != ta.geometry.get() || theirs.o2 != tb.geometry.get());
}

std::vector<std::array<std::intptr_t, 2>> elementsOf(const fcl::CollisionResultd& result) {
  std::vector<std::array<std::intptr_t, 2>> all;
  for (std::size_t k = 0; k < result.numContacts(); ++k)
    all.push_back({result.getContact(k).b1, result.getContact(k).b2});
  std::sort(all.begin(), all.end());
  return all;
}

bool allOf(const fcl::CollisionResultd& result, const std::function<bool(const fcl::Contactd&)>& holds) {
  for (std::size_t k = 0; k < result.numContacts(); ++k)
    if (!holds(result.getContact(k))) return false;
  return true;
}

void askCollide(const Type& ta, const Type& tb, int i, Random& random, Findings& found) {
  const Placement at = placementOf(random, i);
  const DistanceAnswer known = distance(*ta.geometry, at.a, *tb.geometry, at.b);
  const fcl::CollisionRequestd request(100000, true);
  fcl::CollisionResultd ours;
  fcl_stpbv::collide(ta.geometry.get(), at.a, tb.geometry.get(), at.b, request, ours);
  const Pieces a = ta.pieces(at.a), b = tb.pieces(at.b);
  const bool shapes = !ta.elements && !tb.elements;
  const bool answers = known.status != DistanceStatus::invalid;
  if (!answers) found.unanswered();
  const Truth truth = truthOf(a, b, true);
  const bool clear = truth.overlap || truth.distance > kFine;  // nearer to contact, rounding decides
  const auto inOrder = [&](const fcl::Contactd& c) {
    return c.o1 == ta.geometry.get() && c.o2 == tb.geometry.get();
  };
  const auto near = [&](const fcl::Contactd& c) {
    const double within = std::abs(c.penetration_depth) + kCoarse;
    return distanceOf(only(a, c.b1), c.pos) <= within && distanceOf(only(b, c.b2), c.pos) <= within;
  };
  const auto separates = [&](const fcl::Contactd& c, double slack) {
    return gapAlong(a, b, c.normal) >= -std::abs(c.penetration_depth) - slack;
  };
  const bool bounded = shapes && !ta.unbounded() && !tb.unbounded();
  found.ours("in contact or not", clear && ours.isCollision() != truth.overlap);
  if (answers) {
    found.ours("o1, o2 of a contact", !allOf(ours, inOrder));
    found.ours("place of a contact", !allOf(ours, near));
    found.ours("elements of contacts", truth.overlap && elementsOf(ours) != truth.meeting);
    if (bounded && ours.isCollision())
      checkDepth(a, b, ours.getContact(0).penetration_depth, ours.getContact(0).normal, found);
  }

  fcl::CollisionResultd theirs;
  fcl::collide(ta.geometry.get(), at.a, tb.geometry.get(), at.b, request, theirs);
  if (clear) {
    found.theirs('m', truth.overlap && !theirs.isCollision());
    found.theirs('u', !truth.overlap && theirs.isCollision());
  }
  if (!truth.overlap || !theirs.isCollision()) return;
  found.theirs('o', !allOf(theirs, inOrder));
  if (!allOf(theirs, inOrder)) return;  // the other fields are those of the other order
  found.theirs('q', !allOf(theirs, near));
  if (shapes) {
    found.theirs('b', !allOf(theirs, [](const fcl::Contactd& c) { return c.b1 == -1 && c.b2 == -1; }));
  } else {
    found.theirs('b', elementsOf(theirs) != truth.meeting);
  }
  if (!bounded || !answers) return;
  double deepest = 0;
  for (std::size_t k = 0; k < theirs.numContacts(); ++k)
    deepest = std::max(deepest, theirs.getContact(k).penetration_depth);
  found.theirs('d', std::abs(deepest + known.distance) > kDepth);
  found.theirs('v', !allOf(theirs, [&](const fcl::Contactd& c) {
                 return std::abs(c.penetration_depth - deepest) > 0 || separates(c, kCoarse);
               }));
}

}  // namespace

Question distanceQuestion(bool isSigned) {
  return [isSigned](const Type& a, const Type& b, int i, Random& random, Findings& found) {
    askDistance(isSigned, a, b, i, random, found);
  };
}

Question collideQuestion() { return askCollide; }

}  // namespace fcl_stpbv::parity
