// A tree of oriented boxes over a cloud. It finds the point that rises highest over a ball, and the points
// near a given place.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

class PointTree {
 public:
  explicit PointTree(const std::vector<Eigen::Vector3d>& points);

  struct Highest {
    int index = -1;
    double height = 0;
  };

  /// The point with the largest height over a ball's surface, `curvature |q|^2 / 2 + normal.q` with `q = p -
  /// anchor`. If that height is at most `tolerance`, `near` receives all points higher than `-tolerance`.
  /// Otherwise the content of `near` is meaningless.
  Highest highest(const Eigen::Vector3d& anchor, const Eigen::Vector3d& normal, double curvature,
                  double tolerance, std::vector<int>* near) const;

  /// highest() among the few points that the tree stores next to the point `beside`. The result is a guess
  /// where to look.
  Highest highestBeside(int beside, const Eigen::Vector3d& anchor, const Eigen::Vector3d& normal,
                        double curvature) const;

  /// All points within `radius` of `centre`. The search ends when at least `atMost` points are found.
  void within(const Eigen::Vector3d& centre, double radius, std::vector<int>* found,
              std::size_t atMost = std::numeric_limits<std::size_t>::max()) const;

  /// Makes a point invisible to every later query.
  void remove(int index) { removed_[at(index)] = 1; }
  bool isRemoved(int index) const { return removed_[at(index)] != 0; }

 private:
  struct Node {
    Eigen::Matrix3d axes;       // rows: the box's directions
    Eigen::Vector3d low, high;  // bounds of the node's points along the axes, relative to centre_
    double far2;                // largest squared distance of the node's points from centre_
    int begin, end;             // range of order_
    int right;  // index of the second child, -1 for a leaf; the first child follows its parent
  };
  int makeNode(int begin, int end);

  const std::vector<Eigen::Vector3d>& points_;
  Eigen::Vector3d centre_{0, 0, 0};  // of the smallest ball around the points
  std::vector<int> order_;
  std::vector<Eigen::Vector3d> sorted_;  // points in the order of order_
  std::vector<int> place_;               // place of each point in order_
  std::vector<Node> nodes_;
  std::vector<char> removed_;
};

}  // namespace fcl_stpbv::detail
