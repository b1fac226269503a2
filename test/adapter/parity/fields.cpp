// Tests the effect of single fields of FCL's requests and results, in FCL and in this library.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/geometric_shape_to_BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/motion/spline_motion.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/continuous_collision.h>
#include <fcl/narrowphase/distance.h>

#include "fcl_stpbv/adapter/collide.h"
#include "fcl_stpbv/adapter/continuous_collide.h"
#include "test/adapter/parity/questions.h"

namespace fcl_stpbv::parity {

using namespace test;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using Distances = fcl::DistanceResultd;
using Collisions = fcl::CollisionResultd;
using Motions = fcl::ContinuousCollisionResultd;

namespace {

Isometry3d at(double x, double y = 0, double z = 0) { return pose(Eigen::Matrix3d::Identity(), {x, y, z}); }
Isometry3d turned(double x) {
  return pose(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix(), {x, 0.1, 0.2});
}

/// Both libraries behind one interface.
struct Library {
  bool ours;
  const fcl::Boxd box{0.2, 0.2, 0.2};
  const fcl::Coned cone{0.1, 0.3};
  std::shared_ptr<fcl::BVHModel<fcl::RSSd>> mesh = std::make_shared<fcl::BVHModel<fcl::RSSd>>();

  explicit Library(bool own) : ours(own) {
    fcl::generateBVHModel(*mesh, fcl::Sphered(0.1), Isometry3d::Identity(), 16, 16);
  }
  Distances distance(const fcl::CollisionGeometryd& a, const fcl::CollisionGeometryd& b,
                     const Isometry3d& there, const fcl::DistanceRequestd& request,
                     Distances result = Distances()) const {
    (ours ? static_cast<double (*)(const fcl::CollisionGeometryd*, const Isometry3d&,
                                   const fcl::CollisionGeometryd*, const Isometry3d&,
                                   const fcl::DistanceRequestd&, Distances&)>(fcl_stpbv::distance)
          : static_cast<double (*)(const fcl::CollisionGeometryd*, const Isometry3d&,
                                   const fcl::CollisionGeometryd*, const Isometry3d&,
                                   const fcl::DistanceRequestd&, Distances&)>(fcl::distance<double>))(
        &a, at(0), &b, there, request, result);
    return result;
  }
  std::size_t collide(const fcl::CollisionGeometryd& a, const fcl::CollisionGeometryd& b,
                      const Isometry3d& there, const fcl::CollisionRequestd& request,
                      Collisions& result) const {
    return ours ? fcl_stpbv::collide(&a, at(0), &b, there, request, result)
                : fcl::collide(&a, at(0), &b, there, request, result);
  }
  /// Moves the first box between the given poses, past or into the second one at the origin.
  double move(const Isometry3d& from, const Isometry3d& to, const fcl::ContinuousCollisionRequestd& request,
              Motions& result) const {
    return ours ? fcl_stpbv::continuousCollide(&box, from, to, &box, at(0), at(0), request, result)
                : fcl::continuousCollide(&box, from, to, &box, at(0), at(0), request, result);
  }
};

std::string yes(bool does, const char* then, const char* otherwise) { return does ? then : otherwise; }

struct Field {
  const char* name;
  const char* asked;
  std::function<std::string(const Library&)> found;
  const char* right;
};

constexpr const char* kChanges = "changes the answer";
constexpr const char* kSame = "changes nothing";

std::vector<Field> distanceFields() {
  const auto apart = [](const Library& l, const fcl::DistanceRequestd& request) {
    return l.distance(l.cone, l.box, turned(0.5), request).min_distance;
  };
  const auto compare = [apart](const fcl::DistanceRequestd& request) {
    return [=](const Library& l) {
      return yes(apart(l, request) != apart(l, fcl::DistanceRequestd(true)), kChanges, kSame);
    };
  };
  return {
      {"`DistanceResult`, used again", "a nearer pair was in it",
       [](const Library& l) {
         const fcl::DistanceRequestd request(true);
         const Distances near = l.distance(l.box, l.box, at(0.3), request);
         return yes(l.distance(l.box, l.box, at(1), request, near).min_distance < 0.5,
                    "the nearer pair stays", "filled afresh");
       },
       "here: a result of one call is that call's"},
      {"`enable_nearest_points` false", "two boxes apart",
       [](const Library& l) {
         Distances result;
         for (Vector3d& p : result.nearest_points) p.setConstant(7);
         result = l.distance(l.box, l.box, at(1), fcl::DistanceRequestd(false), result);
         return yes(result.nearest_points[0].x() == 7, "points as they were", "points filled");
       },
       "both"},
      {"`enable_signed_distance` false", "two boxes 5 cm deep",
       [](const Library& l) {
         const double d = l.distance(l.box, l.box, at(0.15), fcl::DistanceRequestd(true)).min_distance;
         return yes(d == -1, "-1", "minus the depth");
       },
       "both; FCL leaves it open"},
      {"`distance_tolerance` 1e-10", "a cone and a box",
       compare(fcl::DistanceRequestd(true, false, 0, 0, 1e-10)), "here: exact without one"},
      {"`gjk_solver_type` `GST_INDEP`", "a cone and a box",
       compare(fcl::DistanceRequestd(true, false, 0, 0, 1e-6, fcl::GST_INDEP)), "here: one exact answer"},
      {"`rel_err` 0.5, `abs_err` 0.1", "a mesh and a mesh",
       [](const Library& l) {
         const auto found = [&](const fcl::DistanceRequestd& request) {
           return l.distance(*l.mesh, *l.mesh, turned(0.5), request).min_distance;
         };
         return yes(found(fcl::DistanceRequestd(true, false, 0.5, 0.1)) != found(fcl::DistanceRequestd(true)),
                    kChanges, kSame);
       },
       "both: FCL trades precision for time"},
      {"a pose with a number that is none", "two boxes",
       [](const Library& l) {
         const double d = l.distance(l.box, l.box, at(NAN), fcl::DistanceRequestd(true)).min_distance;
         return yes(d == -1, "-1: no answer", "some number");
       },
       "here"},
  };
}

std::vector<Field> collisionFields() {
  const auto contacts = [](const Library& l, const fcl::CollisionRequestd& request, Collisions& result) {
    return l.collide(l.box, l.cone, turned(0.12), request, result);
  };
  return {
      {"`CollisionResult`, used again", "`num_max_contacts` 10",
       [contacts](const Library& l) {
         Collisions result;
         contacts(l, fcl::CollisionRequestd(10, true), result);
         const std::size_t first = result.numContacts();
         contacts(l, fcl::CollisionRequestd(10, true), result);
         return yes(result.numContacts() == 2 * first, "contacts are added", "filled afresh");
       },
       "both"},
      {"`num_max_contacts` 2", "a mesh and a mesh, deep",
       [](const Library& l) {
         Collisions result;
         l.collide(*l.mesh, *l.mesh, at(0.05, 0.03, 0.02), fcl::CollisionRequestd(2, true), result);
         return std::to_string(result.numContacts()) + " contacts";
       },
       "both"},
      {"`num_max_contacts` 0", "a box and a cone",
       [contacts](const Library& l) {
         Collisions result;
         return std::to_string(contacts(l, fcl::CollisionRequestd(0, true), result)) + " contacts";
       },
       "both"},
      {"`enable_contact` false", "two boxes 5 cm deep",
       [](const Library& l) {
         Collisions result;
         l.collide(l.box, l.box, at(0.15), fcl::CollisionRequestd(10, false), result);
         return std::to_string(result.numContacts()) + " contact";  // FCL leaves the depth uninitialised
       },
       "both"},
      {"`enable_contact` true", "two boxes 5 cm deep, side on side",
       [](const Library& l) {
         Collisions result;
         l.collide(l.box, l.box, at(0.15), fcl::CollisionRequestd(10, true), result);
         return std::to_string(result.numContacts()) + yes(result.numContacts() > 1, " contacts", " contact");
       },
       "both: FCL gives the corners of the patch, here there is the deepest place"},
      {"`enable_cost` true", "two boxes",
       [](const Library& l) {
         Collisions result;
         l.collide(l.box, l.box, at(0.15), fcl::CollisionRequestd(10, true, 10, true), result);
         return yes(result.numCostSources() > 0, "cost sources", "none");
       },
       "FCL; nothing exact stands behind them, so they are left out here"},
      {"`cached_gjk_guess` of the result", "`enable_cached_gjk_guess` true",
       [contacts](const Library& l) {
         Collisions result;
         result.cached_gjk_guess.setConstant(7);
         fcl::CollisionRequestd request(1, true);
         request.enable_cached_gjk_guess = true;
         request.gjk_solver_type = fcl::GST_INDEP;
         contacts(l, request, result);
         return yes(result.cached_gjk_guess.x() == 7, "as it was", "filled");
       },
       "both; here `PairCache` is what remembers"},
      {"`gjk_tolerance` 1e-10", "a box and a cone",
       [contacts](const Library& l) {
         Collisions one, two;
         fcl::CollisionRequestd fine(1, true);
         fine.gjk_tolerance = 1e-10;
         contacts(l, fine, one);
         contacts(l, fcl::CollisionRequestd(1, true), two);
         return yes(one.numContacts() != two.numContacts() ||
                        one.getContact(0).penetration_depth != two.getContact(0).penetration_depth,
                    kChanges, kSame);
       },
       "here: exact without one"},
  };
}

std::vector<Field> motionFields() {
  const auto requestOf = [](std::size_t steps, fcl::CCDMotionType motion, fcl::CCDSolverType solver) {
    return fcl::ContinuousCollisionRequestd(steps, 1e-4, motion, fcl::GST_LIBCCD, solver);
  };
  const auto hit = [=](const Isometry3d& from, const Isometry3d& to, fcl::CCDMotionType motion,
                       fcl::CCDSolverType solver, std::size_t steps = 10) {
    return [=](const Library& l) {
      Motions result;
      const double t = l.move(from, to, requestOf(steps, motion, solver), result);
      return t < 0 ? yes(result.is_collide, "-1, counted as a contact", "-1, counted as free")
                   : yes(result.is_collide, "a contact", "free");
    };
  };
  const Isometry3d left = at(-1.05), right = at(1);
  return {
      {"`num_max_iterations` 3", "through a box between two samples",
       hit(at(-0.5, 0.1), at(1.1, -0.1), fcl::CCDM_TRANS, fcl::CCDC_NAIVE, 3), "here: a proof"},
      {"`num_max_iterations` 10", "a box through a box", hit(left, right, fcl::CCDM_TRANS, fcl::CCDC_NAIVE),
       "both"},
      {"`toc_err` 1e-4", "a box through a box",
       [=](const Library& l) {
         Motions result;
         const double t = l.move(left, right, requestOf(10, fcl::CCDM_TRANS, fcl::CCDC_NAIVE), result);
         return yes(std::abs(t - 0.85 / 2.05) <= 1e-4, "kept", "the next sample's time");
       },
       "here"},
      {"`ccd_motion_type` `CCDM_TRANS`", "a box through a box",
       hit(left, right, fcl::CCDM_TRANS, fcl::CCDC_CONSERVATIVE_ADVANCEMENT), "both"},
      {"`ccd_motion_type` `CCDM_SCREW`", "a box through a box, turning",
       hit(left, turned(1), fcl::CCDM_SCREW, fcl::CCDC_NAIVE), "both"},
      {"`ccd_solver_type` `CCDC_RAY_SHOOTING`", "a box through a box",
       hit(left, right, fcl::CCDM_TRANS, fcl::CCDC_RAY_SHOOTING), "here: FCL has not written it"},
      {"`ccd_solver_type` `CCDC_POLYNOMIAL_SOLVER`", "a box through a box",
       hit(left, right, fcl::CCDM_TRANS, fcl::CCDC_POLYNOMIAL_SOLVER), "here: FCL has it for meshes only"},
      {"`SplineMotion` of control points", "a box through a box",
       [=](const Library& l) {
         const Vector3d zero(0, 0, 0);
         const fcl::SplineMotion<double> motion(Vector3d(-3, 0, 0), Vector3d(-1, 0, 0), Vector3d(1, 0, 0),
                                                Vector3d(3, 0, 0), zero, zero, zero, zero);
         fcl::TranslationMotion<double> still(at(0), at(0));
         Motions result;
         const auto request = requestOf(10, fcl::CCDM_SPLINE, fcl::CCDC_NAIVE);
         const double t = l.ours
                              ? fcl_stpbv::continuousCollide(&l.box, &motion, &l.box, &still, request, result)
                              : fcl::continuousCollide(&l.box, &motion, &l.box, &still, request, result);
         return t < 0 ? yes(result.is_collide, "-1, counted as a contact", "-1, counted as free")
                      : yes(result.is_collide, "a contact", "free");
       },
       "FCL, by samples; refused here, as no bound on splines is proven"},
      {"poses of a free motion", "past a box",
       [=](const Library& l) {
         Motions result;
         result.contact_tf1 = at(7);
         l.move(at(-1, 1), at(1, 1), requestOf(10, fcl::CCDM_TRANS, fcl::CCDC_NAIVE), result);
         return yes(result.contact_tf1.translation().x() == 7, "as they were", "those of the end");
       },
       "both"},
      {"a pose with a number that is none", "two boxes",
       hit(at(NAN), right, fcl::CCDM_TRANS, fcl::CCDC_NAIVE), "here: nothing is known"},
  };
}

/// Runs in a child process, because FCL may end it. The text is returned in the way letters are: by a
/// question about one field.
std::string answerOf(const Field& field, bool ours) {
  const Type none{};
  const auto question = [&](const Type&, const Type&, int, Random&, Findings& found) {
    found.say(field.found(Library(ours)).c_str());
  };
  return cellsOf({{&none, &none}}, question, 1)[0];
}

}  // namespace

std::string fieldTable() {
  std::string text = "| entry | field | asked about | FCL | here | right |\n|---|---|---|---|---|---|\n",
              same;
  const std::pair<const char*, std::vector<Field>> entries[] = {{"`distance`", distanceFields()},
                                                                {"`collide`", collisionFields()},
                                                                {"`continuousCollide`", motionFields()}};
  for (const auto& [entry, fields] : entries)
    for (const Field& field : fields) {
      const std::string theirs = answerOf(field, false), ours = answerOf(field, true);
      if (theirs == ours)
        same += std::string("\n- ") + field.name + ", " + field.asked + ": " + ours;
      else
        text += std::string("| ") + entry + " | " + field.name + " | " + field.asked + " | " + theirs +
                " | " + ours + " | " + field.right + " |\n";
    }
  return text + "\nThe same in both, where asked:\n" + same + "\n";
}

}  // namespace fcl_stpbv::parity
