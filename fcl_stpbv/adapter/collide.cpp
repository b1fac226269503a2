// Descends through both hierarchies (posed_geometry.h). Each pair of elements that is not certainly apart is
// a contact.
#include "fcl_stpbv/adapter/collide.h"

#include <algorithm>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/posed_geometry.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using fcl::CollisionGeometryd;
using fcl::CollisionRequestd;
using fcl::CollisionResultd;
using fcl::Contactd;
using fcl::Transform3d;

/// Fills a result up to its largest number of contacts.
class Contacts {
 public:
  Contacts(const CollisionRequestd& request, CollisionResultd& result, PairCache* cache)
      : request_(request), result_(result), cache_(cache ? *cache : own_) {}

  const PairCache& cache() const { return cache_; }
  bool full() const { return result_.numContacts() >= request_.num_max_contacts; }

  /// Adds `contact` of two bodies unless they are certainly apart. The caller has set its geometries and
  /// elements.
  void add(const ConvexBody& a, const ConvexBody& b, Contactd& contact) {
    if (request_.enable_contact ? meet(a, b, contact) : !isFartherThan(0.0, a, b, &cache_))
      result_.addContact(contact);
  }

 private:
  /// Whether the exact distance is cheaper than the yes-or-no test, which visits a polytope's vertices again.
  static bool isQuick(const ConvexBody& a, const ConvexBody& b) {
    const auto is = [](const ConvexBody& c, ShapeKind kind) { return !c.volume && c.shape.kind == kind; };
    if (a.unbounded() || b.unbounded()) return true;
    if (!a.volume && !b.volume) return is(a, ShapeKind::point) || is(b, ShapeKind::point);
    return (a.volume && b.volume) || is(a, ShapeKind::polytope) || is(b, ShapeKind::polytope);
  }
  bool meet(const ConvexBody& a, const ConvexBody& b, Contactd& contact) {
    const bool apart = isQuick(a, b) ? isFartherByBounds(a.rounding + b.rounding, a, b, cache_)
                                     : isFartherThan(0.0, a, b, &cache_);
    if (apart) return false;
    const Distance found = distance(a, b, &cache_);
    // No answer: `contact` stays as the caller has made it.
    if (found.status == DistanceStatus::invalid) return true;
    contact.normal = found.normal;
    contact.pos = 0.5 * (found.point[0] + found.point[1]);
    contact.penetration_depth = std::max(0.0, -found.distance);
    return !(found.lower > 0);
  }

  const CollisionRequestd& request_;
  CollisionResultd& result_;
  PairCache own_;
  PairCache& cache_;
};

/// Visitor of descend() that adds the contacts of all elements.
class ElementContacts {
 public:
  ElementContacts(const PosedPair& pair, const Contactd& blank, Contacts& found)
      : pair_(pair), blank_(blank), found_(found) {}

  double bound(const PosedGeometry::Part& a, const PosedGeometry::Part& b) const {
    return gapOf(pair_, a, b, 0.0, pair_.known(found_.cache()));
  }
  bool skip(double bound) const { return bound > 0; }

  bool leaves(const PosedGeometry::Part& leafA, const PosedGeometry::Part& leafB) {
    ConvexBody a, b;
    if (!pair_.first.body(leafA, a) || !pair_.second.body(leafB, b)) return false;  // a free cell
    Contactd contact = blank_;
    contact.b1 = leafA.node.id;
    contact.b2 = leafB.node.id;
    found_.add(a, b, contact);
    return found_.full();
  }

 private:
  const PosedPair& pair_;
  const Contactd& blank_;
  Contacts& found_;
};

}  // namespace

std::size_t collide(const CollisionGeometryd* geometry1, const Transform3d& pose1,
                    const CollisionGeometryd* geometry2, const Transform3d& pose2,
                    const CollisionRequestd& request, CollisionResultd& result, const QueryContext& context) {
  Contacts contacts(request, result, context.cache);
  if (contacts.full() || !isOccupied(*geometry1) || !isOccupied(*geometry2)) return result.numContacts();
  Contactd unknown(geometry1, geometry2, Contactd::NONE, Contactd::NONE);
  unknown.normal.setZero();
  unknown.pos.setZero();
  unknown.penetration_depth = request.enable_contact ? kInfinity : 0;
  ConvexBody bodyA, bodyB;
  if (areBodies(*geometry1, pose1, *geometry2, pose2, bodyA, bodyB)) {
    contacts.add(bodyA, bodyB, unknown);
    return result.numContacts();
  }
  const PosedPair pair(*geometry1, pose1, *geometry2, pose2, context.finite);
  if (!pair.valid || !(context.finite || pair.finite())) {
    result.addContact(unknown);
    return result.numContacts();
  }
  ElementContacts elements(pair, unknown, contacts);
  const PosedGeometry::Part a = pair.first.whole(), b = pair.second.whole();
  if (!elements.skip(elements.bound(a, b))) descend(pair, a, b, elements);
  return result.numContacts();
}

std::size_t collide(const fcl::CollisionObjectd* object1, const fcl::CollisionObjectd* object2,
                    const CollisionRequestd& request, CollisionResultd& result, const QueryContext& context) {
  return collide(object1->collisionGeometry().get(), object1->getTransform(),
                 object2->collisionGeometry().get(), object2->getTransform(), request, result, context);
}

bool collisionCallback(fcl::CollisionObjectd* object1, fcl::CollisionObjectd* object2, void* data) {
  CollisionData& query = *static_cast<CollisionData*>(data);
  if (query.done || (query.leaveOut && query.leaveOut(object1, object2))) return query.done;
  QueryContext context;
  context.cache = query.caches ? &query.caches->of(object1, object2) : nullptr;
  context.finite = query.finite;
  query.done =
      collide(object1, object2, query.request, query.result, context) >= query.request.num_max_contacts;
  return query.done;
}

}  // namespace fcl_stpbv
