// Down both hierarchies; each pair of elements that is not certainly apart is a contact.
#include "fcl_stpbv/adapter/collide.h"

#include <algorithm>
#include <limits>

#include "fcl_stpbv/adapter/distance_callback.h"
#include "fcl_stpbv/adapter/posed_geometry.h"
#include "fcl_stpbv/adapter/proximity.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using fcl::CollisionGeometryd;
using fcl::CollisionRequestd;
using fcl::CollisionResultd;
using fcl::Contactd;
using fcl::Transform3d;

class Contacts {
 public:
  Contacts(const PosedPair& pair, const Contactd& blank, const CollisionRequestd& request,
           CollisionResultd& result, PairCache* cache)
      : pair_(pair), blank_(blank), request_(request), result_(result), cache_(cache) {}

  double bound(const PosedGeometry::Part& a, const PosedGeometry::Part& b) const {
    return gapOf(pair_, a, b);
  }
  bool skip(double bound) const { return bound > 0; }

  bool leaves(const PosedGeometry::Part& leafA, const PosedGeometry::Part& leafB) {
    ConvexBody a, b;
    if (!pair_.first.body(leafA, a) || !pair_.second.body(leafB, b)) return false;  // a free cell
    Contactd contact = blank_;
    contact.b1 = leafA.node.id;
    contact.b2 = leafB.node.id;
    if (!(request_.enable_contact ? meet(a, b, contact) : !isFartherThan(0.0, a, b, cache_))) return false;
    result_.addContact(contact);
    return result_.numContacts() >= request_.num_max_contacts;
  }

 private:
  bool meet(const ConvexBody& a, const ConvexBody& b, Contactd& contact) {
    if (isFartherByPlane(0.0, a, b, *cache_)) return false;
    const Distance found = distance(a, b, cache_);
    if (found.status == DistanceStatus::invalid) return true;  // as it is: without an answer
    contact.normal = found.normal;
    contact.pos = 0.5 * (found.point[0] + found.point[1]);
    contact.penetration_depth = std::max(0.0, -found.distance);
    return !(found.lower > 0);
  }

  const PosedPair& pair_;
  const Contactd& blank_;
  const CollisionRequestd& request_;
  CollisionResultd& result_;
  PairCache* cache_;
};

}  // namespace

std::size_t collide(const CollisionGeometryd* geometry1, const Transform3d& pose1,
                    const CollisionGeometryd* geometry2, const Transform3d& pose2,
                    const CollisionRequestd& request, CollisionResultd& result, PairCache* cache) {
  if (result.numContacts() >= request.num_max_contacts) return result.numContacts();
  Contactd unknown(geometry1, geometry2, Contactd::NONE, Contactd::NONE);
  unknown.normal.setZero();
  unknown.pos.setZero();
  unknown.penetration_depth = request.enable_contact ? std::numeric_limits<double>::infinity() : 0;
  const PosedPair pair(*geometry1, pose1, *geometry2, pose2);
  if (!pair.valid) {
    result.addContact(unknown);
    return result.numContacts();
  }
  PairCache own;
  Contacts contacts(pair, unknown, request, result, cache ? cache : &own);
  const PosedGeometry::Part a = pair.first.whole(), b = pair.second.whole();
  if (!contacts.skip(contacts.bound(a, b))) descend(pair, a, b, contacts);
  return result.numContacts();
}

std::size_t collide(const fcl::CollisionObjectd* object1, const fcl::CollisionObjectd* object2,
                    const CollisionRequestd& request, CollisionResultd& result, PairCache* cache) {
  return collide(object1->collisionGeometry().get(), object1->getTransform(),
                 object2->collisionGeometry().get(), object2->getTransform(), request, result, cache);
}

bool collisionCallback(fcl::CollisionObjectd* object1, fcl::CollisionObjectd* object2, void* data) {
  CollisionData& query = *static_cast<CollisionData*>(data);
  if (query.done) return true;
  PairCache* cache = query.caches ? &query.caches->of(object1, object2) : nullptr;
  query.done =
      collide(object1, object2, query.request, query.result, cache) >= query.request.num_max_contacts;
  return query.done;
}

}  // namespace fcl_stpbv
