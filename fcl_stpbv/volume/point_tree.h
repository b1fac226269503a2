// A tree of oriented boxes over a cloud: which point rises highest over a
// ball, and which points are near another.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace fcl_stpbv::detail {

class PointTree {
 public:
  explicit PointTree(const std::vector<Eigen::Vector3d>& points);

  struct Highest {
    int index = -1;
    double height = 0;
  };

  /// The point with the largest height `curvature |q|^2 / 2 + normal.q`, `q = p - anchor`, over
  /// a ball's surface. Where that is at most `tolerance`, `near` gets all points higher than
  /// `-tolerance`; else `near` is meaningless.
  Highest highest(const Eigen::Vector3d& anchor, const Eigen::Vector3d& normal, double curvature,
                  double tolerance, std::vector<int>* near) const;

  /// The same among the few points that the tree keeps beside point `beside`; a guess where to look.
  Highest highestBeside(int beside, const Eigen::Vector3d& anchor, const Eigen::Vector3d& normal,
                        double curvature) const;

  /// The points closer to `centre` than `radius`: all, or the first `atMost` met.
  void within(const Eigen::Vector3d& centre, double radius, std::vector<int>* found,
              std::size_t atMost = std::numeric_limits<std::size_t>::max()) const;

  /// Makes a point invisible to every later query.
  void remove(int index) { removed_[static_cast<std::size_t>(index)] = 1; }
  bool isRemoved(int index) const { return removed_[static_cast<std::size_t>(index)] != 0; }

 private:
  struct Node {
    Eigen::Matrix3d axes;       // rows: the box's directions
    Eigen::Vector3d low, high;  // of its points in these, from centre_
    double far2;                // of its points, the largest squared distance from centre_
    int begin, end;             // range of order_
    int right;                  // second child; the first one follows its parent; -1 for a leaf
  };
  int makeNode(int begin, int end);

  const std::vector<Eigen::Vector3d>& points_;
  Eigen::Vector3d centre_{0, 0, 0};  // of the smallest ball around the points
  std::vector<int> order_;
  std::vector<Eigen::Vector3d> sorted_;  // points in the order of order_
  std::vector<int> place_;               // where in order_ each point stands
  std::vector<Node> nodes_;
  std::vector<char> removed_;
};

}  // namespace fcl_stpbv::detail
