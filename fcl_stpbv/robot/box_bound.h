// A lower bound on the distance of a pair over a box of joint values (docs/proofs.md): from the distance at
// the box's middle, or from a plane between the two.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "fcl_stpbv/robot/body_points.h"
#include "fcl_stpbv/robot/bounding_ball.h"
#include "fcl_stpbv/robot/pair_proof.h"
#include "fcl_stpbv/robot/pair_search.h"
#include "fcl_stpbv/robot/plane_bound.h"

namespace fcl_stpbv::detail {

/// No value for bodies that cannot be such points.
struct ProofBodies {
  std::vector<std::optional<BodyPoints>> robot;      ///< in the links' frames
  std::vector<std::optional<BodyPoints>> obstacles;  ///< in the world
};

/// The pair as a function of its joints. @throws Error for a link without bodies, and for a link or an
/// obstacle that does not exist.
PairSearch searchOf(const ProofScene& scene, const LinkPair& pair);

/// Avoids the sum of the limits, which may overflow. A lazy expression: one coordinate can be computed alone.
inline auto middleOf(const JointBox& box) { return 0.5 * box.lower + 0.5 * box.upper; }

/// One box at a time. The result for a box depends only on that box.
class BoxBound {
 public:
  enum class Verdict { clear, collision, unclear };

  /// @throws Error as searchOf() does. The scene must outlive it.
  BoxBound(const ProofScene& scene, const LinkPair& pair);

  Eigen::Index coordinates() const { return static_cast<Eigen::Index>(search_.coordinates().size()); }
  /// Whether the pair has a bound: none across planar and floating joints or a moving base.
  bool hasBound() const { return lipschitz_.allFinite(); }

  /// Whether the pair keeps the scene's margin all over the box, or collides at its middle.
  Verdict look(const JointBox& box);
  /// The middle of the last box: all coordinates.
  const Eigen::VectorXd& middle() const { return q_; }
  /// Where to cut the last box: the coordinate that takes most from the gap. -1 if none takes anything, or if
  /// no number lies between the ends of those that do.
  int cut() const { return cut_; }

  /// Lower bound on the distance all over the box (m).
  double lowerBound(const JointBox& box);

 private:
  void ask(const JointBox& box);
  double bound(double enough);
  void chooseCut(const Eigen::VectorXd& share);
  void place();
  double longestWay() const;
  double planeBound(const CheckedPair& pair, const DistanceAnswer& answer, double enough);

  struct Hop {  // a joint on the way from the root to one of the two links
    const JointModel* joint;
    int coordinate = -1;  // into q, of a joint that slides; -1 for others
    int slot = -1;        // the same among the pair's coordinates, if it is one of them
  };
  void addHops(int link);
  void addBalls();

  const ProofScene& scene_;
  LinkPair pair_;
  PairSearch search_;
  Eigen::VectorXd q_, lipschitz_;
  Eigen::VectorXd half_, share_, taken_;  // of the box: half widths, what each coordinate takes from the gap
  std::vector<BoxJoint> joints_;
  std::vector<const JointModel*> models_;
  std::vector<Hop> hops_;
  std::vector<std::pair<int, BoundingBall>> balls_;  // around the bodies, each with its link
  double obstacleReach_ = 0;                         // bound on the obstacle's coordinates (m)
  PlaneBound bound_;
  BodyPoints first_, second_;
  double distance_ = 0, slack_ = 0;
  bool leversHold_ = true;  // whether lipschitz_ holds: only within the limits of joints that slide
  Eigen::VectorXd cuts_;    // of the box: 1 for each coordinate that can be cut, else 0
  int cut_ = -1;
};

}  // namespace fcl_stpbv::detail
