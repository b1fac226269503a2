// A tree of oriented boxes over a cloud. Each box has the principal axes of its points (as in Gottschalk,
// Lin, Manocha, OBBTree, 1996), and is split at the median along its longest axis. The highest point over a
// ball is found by branch and bound. The bound of a box is the sum of the largest values for each coordinate,
// or the bound by the sphere around the cloud's centre if that is lower. Points on a surface have thin boxes,
// so the bound is tight.
#include "fcl_stpbv/volume/point_tree.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/minimum_ball.h"

namespace fcl_stpbv::detail {
namespace {

constexpr int kLeaf = 8;    // points in a leaf: scanning eight costs about as much as one more level of boxes
constexpr int kStack = 96;  // more entries than a balanced tree of 2^31 points needs

// Rows: the principal axes of points[begin, end), along which the coordinates are uncorrelated. If the
// coordinates are so large or so small that these cannot be computed, any three directions at right angles.
template <class Point>
Eigen::Matrix3d principalAxes(const Point& point, int begin, int end) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int i = begin; i < end; ++i) mean += point(i) / (end - begin);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (int i = begin; i < end; ++i) spread += (point(i) - mean) * (point(i) - mean).transpose();
  if (!spread.allFinite()) return Eigen::Matrix3d::Identity();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().transpose();
}

}  // namespace

PointTree::PointTree(const std::vector<Eigen::Vector3d>& points)
    : points_(points), order_(points.size()), removed_(points.size(), 0) {
  std::iota(order_.begin(), order_.end(), 0);
  if (!points.empty()) centre_ = minimumEnclosingBall(points).centre;
  nodes_.reserve(points.size() / (kLeaf / 4) + 1);
  if (!points.empty()) makeNode(0, static_cast<int>(points.size()));
  sorted_.reserve(points.size());
  place_.resize(points.size());
  for (const int i : order_) {
    place_[at(i)] = static_cast<int>(sorted_.size());
    sorted_.push_back(points[at(i)]);
  }
}

int PointTree::makeNode(int begin, int end) {
  const auto fromCentre = [&](int i) -> Eigen::Vector3d { return points_[at(order_[at(i)])] - centre_; };
  Node node{principalAxes(fromCentre, begin, end), {}, {}, 0, begin, end, -1};
  node.low = node.high = node.axes * fromCentre(begin);
  for (int i = begin; i < end; ++i) {
    const Eigen::Vector3d q = fromCentre(i), p = node.axes * q;
    node.low = node.low.cwiseMin(p);
    node.high = node.high.cwiseMax(p);
    node.far2 = std::max(node.far2, q.squaredNorm());
  }
  const int index = static_cast<int>(nodes_.size());
  nodes_.push_back(node);
  if (end - begin > kLeaf) {
    int longest = 0;
    (node.high - node.low).maxCoeff(&longest);
    const Eigen::Vector3d axis = node.axes.row(longest);
    const int middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](int i, int j) { return axis.dot(points_[at(i)]) < axis.dot(points_[at(j)]); });
    makeNode(begin, middle);
    const int right = makeNode(middle, end);
    nodes_[at(index)].right = right;
  }
  return index;
}

PointTree::Highest PointTree::highest(const Eigen::Vector3d& anchor, const Eigen::Vector3d& normal,
                                      double curvature, double tolerance, std::vector<int>* near) const {
  near->clear();
  Highest best;
  best.height = -kInfinity;
  if (nodes_.empty()) return best;

  // In any three directions at right angles the height is a sum of convex functions, one of each coordinate.
  // So over a box each of these functions takes its largest value at one of its two ends.
  const Eigen::Vector3d from = anchor - centre_;
  const double size = std::sqrt(nodes_[0].far2) + from.norm();
  const double boxRounding =
      32 * std::numeric_limits<double>::epsilon() * size * (curvature * size + normal.norm());
  const auto bound = [&](const Node& node) {
    const Eigen::Vector3d a = node.axes * from, n = node.axes * normal;
    double sum = boxRounding;
    for (int k = 0; k < 3; ++k) {
      const double l = node.low[k] - a[k], h = node.high[k] - a[k];
      sum += std::max(l * (0.5 * curvature * l + n[k]), h * (0.5 * curvature * h + n[k]));
    }
    return sum;
  };
  // For a box of points on a sphere, that bound is too high by the bulge of the sphere in the box. So no box
  // would be pruned if the ball is nearly that sphere. Measured from the sphere's centre o, the height is a
  // linear function of p and |p - o|^2, and each node stores the largest |p - o|^2.
  const Eigen::Vector3d o = -from, slope = curvature * o + normal;
  const double level = 0.5 * curvature * o.squaredNorm() + normal.dot(o);
  const double rounding = 32 * std::numeric_limits<double>::epsilon() *
                          (curvature * (nodes_[0].far2 + o.squaredNorm()) + normal.norm() * o.norm() +
                           slope.norm() * std::sqrt(nodes_[0].far2));
  const auto sphereBound = [&](const Node& node) {
    const Eigen::Vector3d s = node.axes * slope;
    return level + 0.5 * curvature * node.far2 +
           s.cwiseProduct(node.low).cwiseMax(s.cwiseProduct(node.high)).sum() + rounding;
  };
  struct Waiting {
    double bound;
    int node;
  };
  std::array<Waiting, kStack> stack;
  int waiting = 0;
  stack[at(waiting++)] = {bound(nodes_[0]), 0};
  while (waiting > 0) {
    const Waiting top = stack[at(--waiting)];
    // Bound and height may differ by rounding. So a node is left out only if its bound is lower by more than
    // that.
    const double wanted = best.height > tolerance ? best.height : -2 * tolerance;
    if (top.bound < wanted) continue;
    const Node& node = nodes_[at(top.node)];
    if (sphereBound(node) < wanted) continue;
    if (node.right < 0) {
      for (int i = node.begin; i < node.end; ++i) {
        const Eigen::Vector3d q = sorted_[at(i)] - anchor;
        const double height = 0.5 * curvature * q.squaredNorm() + normal.dot(q);
        if (height < -tolerance && height <= best.height) continue;
        const int index = order_[at(i)];
        if (isRemoved(index)) continue;
        if (height > best.height) best = {index, height};
        if (best.height <= tolerance && height >= -tolerance) near->push_back(index);
      }
      continue;
    }
    Waiting a{bound(nodes_[static_cast<std::size_t>(top.node) + 1]), top.node + 1};
    Waiting b{bound(nodes_[at(node.right)]), node.right};
    if (a.bound > b.bound) std::swap(a, b);
    stack[at(waiting++)] = a;  // the child with the higher bound is visited first
    stack[at(waiting++)] = b;
  }
  return best;
}

PointTree::Highest PointTree::highestBeside(int beside, const Eigen::Vector3d& anchor,
                                            const Eigen::Vector3d& normal, double curvature) const {
  constexpr int kReach = 3 * kLeaf;  // three leaves to either side
  const int place = place_[at(beside)];
  const int begin = std::max(0, place - kReach),
            end = std::min(static_cast<int>(sorted_.size()), place + kReach);
  Highest best{-1, -kInfinity};
  for (int i = begin; i < end; ++i) {
    const Eigen::Vector3d q = sorted_[at(i)] - anchor;
    const double height = 0.5 * curvature * q.squaredNorm() + normal.dot(q);
    if (height <= best.height) continue;
    const int index = order_[at(i)];
    if (!isRemoved(index)) best = {index, height};
  }
  return best;
}

void PointTree::within(const Eigen::Vector3d& centre, double radius, std::vector<int>* found,
                       std::size_t atMost) const {
  found->clear();
  if (nodes_.empty()) return;
  const double radius2 = radius * radius;
  const Eigen::Vector3d from = centre - centre_;
  const double reach = radius + 8 * std::numeric_limits<double>::epsilon() *
                                    (std::sqrt(nodes_[0].far2) + from.norm());  // the boxes' own rounding
  std::array<int, kStack> stack;
  int waiting = 0;
  stack[at(waiting++)] = 0;
  while (waiting > 0 && found->size() < atMost) {
    const int current = stack[at(--waiting)];
    const Node& node = nodes_[at(current)];
    const Eigen::Vector3d c = node.axes * from;
    const double away = (c.cwiseMax(node.low).cwiseMin(node.high) - c).norm();
    if (away > reach) continue;
    if (node.right < 0) {
      for (int i = node.begin; i < node.end; ++i) {
        const int index = order_[at(i)];
        if ((sorted_[at(i)] - centre).squaredNorm() <= radius2 && !isRemoved(index)) found->push_back(index);
      }
      continue;
    }
    stack[at(waiting++)] = current + 1;
    stack[at(waiting++)] = node.right;
  }
}

}  // namespace fcl_stpbv::detail
