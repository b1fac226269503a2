// Edges sorted into their vertices' stars, and the climb from star to star.
#include "fcl_stpbv/volume/vertex_graph.h"

#include <numeric>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

VertexGraph::VertexGraph(const std::vector<Eigen::Vector3d>& vertices,
                         const std::vector<std::array<int, 2>>& edges)
    : stars_(vertices.size()) {
  std::vector<std::int32_t> last(vertices.size());  // the star of each vertex that has room
  std::iota(last.begin(), last.end(), 0);
  std::vector<std::size_t> filled(vertices.size(), 0);
  for (const std::array<int, 2>& ends : edges)
    for (const std::size_t side : {0u, 1u}) {
      const std::size_t from = static_cast<std::size_t>(ends[side]);
      const int to = ends[1 - side];
      if (filled[from] == VertexStar::kSize) {
        const auto further = static_cast<std::int32_t>(stars_.size());
        stars_[at(last[from])].next = further;
        last[from] = further;
        stars_.emplace_back();
        filled[from] = 0;
      }
      const Eigen::Vector3d along = vertices[at(to)] - vertices[from];
      VertexStar& star = stars_[at(last[from])];
      for (std::size_t slot = filled[from]++; slot < VertexStar::kSize; ++slot)
        star.set(slot, along.normalized().cast<float>(), to);
    }
  stars_.shrink_to_fit();
}

int VertexGraph::climb(int vertex, const Eigen::Vector3f& d) const {
  const float level = kLevel * d.lpNorm<1>();
  // Each step goes higher, except for rounding. The limit ends a walk around a ring of equal heights.
  std::size_t step = stars_.size();
  for (int over; step > 0 && (over = uphill(vertex, d, level)) != vertex; --step) vertex = over;
  return vertex;
}

}  // namespace fcl_stpbv::detail
