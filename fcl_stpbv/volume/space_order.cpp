// Morton's order: the bits of the three coordinates interleaved, as one number to sort by.
#include <algorithm>
#include <cstdint>
#include <utility>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/quickhull.h"

namespace fcl_stpbv::detail {
namespace {

constexpr int kBits = 10;  // for each coordinate: about a thousand cells along each axis

// The lowest ten bits of x, with two zeros after each.
std::uint32_t spread(std::uint32_t x) {
  x = (x | x << 16) & 0x030000ffu;
  x = (x | x << 8) & 0x0300f00fu;
  x = (x | x << 4) & 0x030c30c3u;
  return (x | x << 2) & 0x09249249u;
}

}  // namespace

std::vector<int> spaceOrder(const std::vector<Eigen::Vector3d>& points) {
  if (points.empty()) return {};
  Eigen::Vector3d low = points[0], high = points[0];
  for (const Eigen::Vector3d& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  // The scale is the same for all axes, so cells are cubes. If a cloud has no size or is too large for a
  // double, all of it is one cell.
  const double size = (high - low).maxCoeff();
  const double cells = (1 << kBits) - 1, scale = size > 0 && cells / size > 0 ? cells / size : 0;
  std::vector<std::pair<std::uint32_t, int>> keys;
  keys.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d cell = scale * (points[i] - low);
    const auto slot = [&](Eigen::Index k) {
      return spread(static_cast<std::uint32_t>(std::min(std::max(0.0, cell[k]), cells)));
    };
    keys.emplace_back(slot(0) | slot(1) << 1 | slot(2) << 2, static_cast<int>(i));
  }
  const auto at = [&](int i) -> const Eigen::Vector3d& { return points[detail::at(i)]; };
  std::sort(keys.begin(), keys.end(), [&](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first < b.first;
    const Eigen::Vector3d &p = at(a.second), &q = at(b.second);
    for (const Eigen::Index k : {0, 1, 2})
      if (p[k] != q[k]) return p[k] < q[k];
    return a.second < b.second;
  });
  std::vector<int> order;
  order.reserve(points.size());
  for (const auto& key : keys)
    if (order.empty() || at(order.back()) != at(key.second)) order.push_back(key.second);
  return order;
}

}  // namespace fcl_stpbv::detail
