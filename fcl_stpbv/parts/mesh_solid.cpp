// Distance to a mesh, and whether a point is inside.
// 1. A tree of boxes, down to single triangles, split at the median along the longest axis.
// 2. Nearest triangle: branch and bound in the tree. Two dot products with precomputed vectors decide whether
//    a point projects into a triangle. If not, only the sides that it is beyond are examined.
// 3. Inside: count the signed crossings of a ray with closed pieces. If rounding makes a crossing uncertain,
//    try the next of eight directions.
#include "fcl_stpbv/parts/mesh_solid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv {
namespace {

using Eigen::Vector3d;

using detail::at;

// Directions for rays. None is along an axis or a plane that a designer would choose.
const std::array<Vector3d, 8>& rayDirections() {
  static const std::array<Vector3d, 8> directions = [] {
    std::array<Vector3d, 8> list;
    for (std::size_t k = 0; k < list.size(); ++k) {  // spread by the golden angle
      const double z = 0.873 - 0.217 * static_cast<double>(k),
                   turn = 0.317 + 2.399963 * static_cast<double>(k);
      const double across = std::sqrt(1 - z * z);
      list[k] = Vector3d(across * std::cos(turn), across * std::sin(turn), z);
    }
    return list;
  }();
  return directions;
}

enum class RayHit { none, up, down, unclear };

// Whether the ray from the origin along `d` crosses a triangle, and which way the triangle faces it. `scale`
// bounds the corners' coordinates.
RayHit rayHit(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d, double scale) {
  constexpr double kRounding = 1e-14;  // units in the last place of products of three, rounded up
  const double area = kRounding * scale * scale, volume = kRounding * scale * scale * scale;
  const std::array<double, 3> w{d.dot(b.cross(c)), d.dot(c.cross(a)), d.dot(a.cross(b))};
  const auto [least, most] = std::minmax_element(w.begin(), w.end());
  if (*least<-area&& * most> area) return RayHit::none;
  if (std::max({d.dot(a), d.dot(b), d.dot(c)}) < -kRounding * scale) return RayHit::none;  // all behind
  const bool up = *least > area, down = *most < -area;
  if (!up && !down) return RayHit::unclear;
  const double height = a.dot(b.cross(c));
  if (std::abs(height) <= volume) return RayHit::unclear;
  if ((height > 0) != up) return RayHit::none;  // the crossing is behind
  return up ? RayHit::up : RayHit::down;
}

// Solid angle of a triangle seen from the origin, signed (van Oosterom and Strackee 1983), in whole turns.
double turnsAround(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb) /
         detail::kTwoPi;
}

}  // namespace

MeshSolid::Foot::Foot(const Triangle& triangle) : a(triangle[0]), u(triangle[1] - a), v(triangle[2] - a) {
  // Sine of the angle. Below it, rounding decides beyond which sides a foot is.
  constexpr double kThin = 1e-6;
  const Vector3d n = u.cross(v);
  const double n2 = n.squaredNorm();
  isThin = !(n2 > kThin * kThin * u.squaredNorm() * v.squaredNorm());
  const double scale = n2 > 0 ? 1 / n2 : std::numeric_limits<double>::quiet_NaN();
  alongU = scale * v.cross(n);
  alongV = scale * n.cross(u);
}

double MeshSolid::Foot::squaredDistance(const Vector3d& p) const {
  const auto fromSegment = [](const Vector3d& from, const Vector3d& along) {
    const double t = from.dot(along), length = along.squaredNorm();
    if (t <= 0) return from.squaredNorm();
    return (t >= length ? Vector3d(from - along) : Vector3d(from - t / length * along)).squaredNorm();
  };
  const Vector3d w = p - a;
  const double beta = w.dot(alongU), gamma = w.dot(alongV), alpha = 1 - beta - gamma;
  double least = detail::kInfinity;
  if (alpha >= 0 && beta >= 0 && gamma >= 0) least = (w - beta * u - gamma * v).squaredNorm();
  // Otherwise the nearest point is on one of the sides beyond which the foot lies.
  if (isThin || gamma < 0) least = std::min(least, fromSegment(w, u));
  if (isThin || beta < 0) least = std::min(least, fromSegment(w, v));
  if (isThin || alpha < 0) least = std::min(least, fromSegment(w - u, v - u));
  return least;
}

MeshSolid::MeshSolid(const TriangleMesh& mesh) : pieces_(meshPieces(mesh)) {
  triangles_.reserve(pieces_.triangles.size());
  for (const std::array<int, 3>& t : pieces_.triangles)
    triangles_.push_back(
        {pieces_.vertices[at(t[0])], pieces_.vertices[at(t[1])], pieces_.vertices[at(t[2])]});
  for (const Triangle& t : triangles_) feet_.emplace_back(t);
  std::vector<int> order(triangles_.size());
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(2 * triangles_.size());
  build(order.begin(), order.end());
}

int MeshSolid::build(std::vector<int>::iterator begin, std::vector<int>::iterator end) {
  const int number = static_cast<int>(nodes_.size());
  Node node{Vector3d::Constant(detail::kInfinity), Vector3d::Constant(-detail::kInfinity), *begin};
  for (auto t = begin; t != end; ++t) {
    for (const Vector3d& p : triangles_[at(*t)]) {
      node.low = node.low.cwiseMin(p);
      node.high = node.high.cwiseMax(p);
    }
  }
  nodes_.push_back(node);
  if (end - begin == 1) return number;
  Eigen::Index axis;
  (node.high - node.low).maxCoeff(&axis);
  const auto middle = begin + (end - begin) / 2;
  const auto along = [&](int t) {
    const Triangle& x = triangles_[at(t)];
    return x[0][axis] + x[1][axis] + x[2][axis];
  };
  std::nth_element(begin, middle, end, [&](int s, int t) { return along(s) < along(t); });
  const int left = build(begin, middle), right = build(middle, end);
  nodes_[at(number)].left = left;
  nodes_[at(number)].right = right;
  return number;
}

MeshSolid::Nearest MeshSolid::nearest(const Vector3d& p, int guess, double enough, long* tried) const {
  double best = detail::kInfinity;
  const double near2 = enough > 0 ? enough * enough : 0;
  int found = guess;
  if (guess >= 0) best = feet_[at(guess)].squaredDistance(p);
  const auto away = [&](int node) {
    const Node& n = nodes_[at(node)];
    return (n.low - p).cwiseMax(p - n.high).cwiseMax(0.0).squaredNorm();
  };
  std::array<std::pair<double, int>, 64> open;  // each level halves the triangles: 32 levels at most
  std::size_t count = 0;
  open[count++] = {away(0), 0};
  while (count > 0 && best > near2) {
    const auto [least, number] = open[--count];
    if (least >= best) continue;
    const Node& node = nodes_[at(number)];
    if (node.left < 0) {
      if (tried) ++*tried;
      const double d = feet_[at(node.triangle)].squaredDistance(p);
      if (d < best) best = d, found = node.triangle;
      continue;
    }
    std::pair<double, int> near{away(node.left), node.left}, far{away(node.right), node.right};
    if (far.first < near.first) std::swap(near, far);
    open[count++] = far;
    open[count++] = near;
  }
  return {std::sqrt(best), found};
}

double MeshSolid::distance(const Vector3d& p, int triangle) const {
  return std::sqrt(feet_[at(triangle)].squaredDistance(p));
}

template <class Misses, class Visit>
bool MeshSolid::each(const Misses& misses, const Visit& visit) const {
  std::array<int, 64> open;  // each level halves the triangles: 32 levels at most
  std::size_t count = 0;
  open[count++] = 0;
  while (count > 0) {
    const Node& node = nodes_[at(open[--count])];
    if (misses(node)) continue;
    if (node.left >= 0) {
      open[count++] = node.left;
      open[count++] = node.right;
      continue;
    }
    if (!visit(node.triangle)) return false;
  }
  return true;
}

bool MeshSolid::within(const Vector3d& low, const Vector3d& high,
                       const std::function<bool(int)>& visit) const {
  return each(
      [&](const Node& node) {
        return (node.low.array() > high.array()).any() || (node.high.array() < low.array()).any();
      },
      visit);
}

template <class Visit>
bool MeshSolid::alongRay(const Vector3d& p, const Vector3d& direction, Visit visit) const {
  const Vector3d inverse = direction.cwiseInverse();
  const double slack = 1e-12 * (high() - low()).norm();  // enlarges boxes, so that no triangle is missed
  return each(
      [&](const Node& node) {
        const Vector3d s = (node.low.array() - slack - p.array()) * inverse.array();
        const Vector3d t = (node.high.array() + slack - p.array()) * inverse.array();
        return s.cwiseMin(t).maxCoeff() > s.cwiseMax(t).minCoeff() || s.cwiseMax(t).minCoeff() < 0;
      },
      visit);
}

MeshSolid::Side MeshSolid::side(const Vector3d& p, const Vector3d& direction) const {
  const double scale = (high() - p).cwiseAbs().cwiseMax((p - low()).cwiseAbs()).norm();
  std::vector<std::pair<int, int>> counts;  // for each piece met: crossings upwards minus crossings downwards
  const bool clear = alongRay(p, direction, [&](int t) {
    const int piece = pieces_.piece[at(t)];
    if (!pieces_.closed[at(piece)]) return true;
    const Triangle& x = triangles_[at(t)];
    const RayHit found = rayHit(x[0] - p, x[1] - p, x[2] - p, direction, scale);
    if (found == RayHit::none) return true;
    if (found == RayHit::unclear) return false;
    auto place = std::find_if(counts.begin(), counts.end(), [&](const auto& c) { return c.first == piece; });
    if (place == counts.end()) place = counts.insert(place, {piece, 0});
    place->second += found == RayHit::up ? 1 : -1;
    return true;
  });
  if (!clear) return Side::unsure;
  const bool enclosed =
      std::any_of(counts.begin(), counts.end(), [](const auto& c) { return c.second != 0; });
  return enclosed ? Side::enclosed : Side::outside;
}

MeshSolid::Side MeshSolid::side(const Vector3d& p) const {
  if ((p.array() < low().array()).any() || (p.array() > high().array()).any()) return Side::outside;
  for (const Vector3d& direction : rayDirections()) {
    const Side found = side(p, direction);
    if (found != Side::unsure) return found;
  }
  return Side::unsure;
}

bool MeshSolid::holds(const Vector3d& p) const {
  const Side certain = side(p);
  if (certain == Side::enclosed) return true;
  if (certain == Side::outside && closed()) return false;
  double turns = 0;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (certain == Side::outside && pieces_.closed[at(pieces_.piece[t])]) continue;
    const Triangle& x = triangles_[t];
    turns += turnsAround(x[0] - p, x[1] - p, x[2] - p);
  }
  return std::abs(turns) > 0.5;
}

}  // namespace fcl_stpbv
