// GJK (Gilbert, Johnson, Keerthi 1988) on the vertices of two STP-BVs. Support points are found by hill
// climbing on both edge graphs side by side, from the vertices found last.
#include "fcl_stpbv/distance/vertex_gjk.h"

#include "fcl_stpbv/convex/gjk.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

/// The difference of the two vertex sets, given by its support points. Remembers the last support vertices.
class VertexDifference {
 public:
  struct Corner {
    Vector3d w{0, 0, 0};
    double gap = 0;
  };

  VertexDifference(const BodyPair& pair, const Vector3d& n)
      : pair_(pair), vertex_{pair.tablesA().vertexNear[n], pair.tablesB().vertexNear[pair.opposite(n)]} {
    climb(n, pair.opposite(n));
  }

  Corner support(const Vector3d& n) {
    climb(n, pair_.opposite(n));
    const Vector3d w = difference(vertex_);
    return {w, n.dot(w)};
  }

  Vector3d difference(const std::array<int, 2>& vertex) const {
    return unpack(pair_.vertexDifference(vertex));
  }
  const std::array<int, 2>& vertex() const { return vertex_; }

 private:
  /// Climbs to the vertices furthest along `d` and, in the second body's frame, along `e`. The two climbs are
  /// interleaved, so that neither waits for the other's loads.
  void climb(const Vector3d& d, const Vector3d& e) {
    const VertexGraph &a = pair_.tablesA().graph, &b = pair_.tablesB().graph;
    const Eigen::Vector3f up = d.cast<float>(), down = e.cast<float>();
    const float level = VertexGraph::kLevel * up.lpNorm<1>();
    auto& [i, j] = vertex_;
    for (int step = pair_.a().vertexCount() + pair_.b().vertexCount(); step > 0; --step) {
      const int overA = a.uphill(i, up, level), overB = b.uphill(j, down, level);
      if (overA == i && overB == j) break;
      i = overA;
      j = overB;
    }
  }

  const BodyPair& pair_;
  std::array<int, 2> vertex_;
};

}  // namespace

FCL_STPBV_VECTORIZED
VertexGjk vertexGjk(const BodyPair& pair, const Vector3d& n, double level) {
  using Corner = VertexDifference::Corner;
  constexpr int kSteps = 20;
  constexpr double kGap = 1e-5;  // relative; the facing features are known long before their distance is
  constexpr double kRounding = 1e-12;  // m
  // The support vertices along `n`, and for each body the neighbour over the edge that descends least.
  VertexDifference difference(pair, n);
  const auto [i, j] = difference.vertex();
  const auto corner = [&](int u, int v) { return Corner{difference.difference({u, v}), -kInfinity}; };
  Simplex<Corner> start;
  start.add(corner(i, j));
  start.add(corner(pair.tablesA().graph.beside(i, n.cast<float>(), 1.0f), j));
  start.add(corner(i, pair.tablesB().graph.beside(j, pair.opposite(n).cast<float>(), 1.0f)));
  const auto enough = [level](double lower, double upper) {
    return upper - lower <= kGap * upper || upper <= level || lower > level;
  };
  const auto found = gjk(difference, start, n, kRounding, kSteps, enough);
  VertexGjk result;
  result.vertex = difference.vertex();
  result.n = found.n;
  const bool overlap = found.verdict == GjkResult<Corner>::Verdict::overlap;
  result.apart = !overlap;
  result.nearest = overlap ? 0.0 : found.upper;
  result.surrounded = overlap && found.simplex.size == 4;
  if (result.surrounded)
    for (std::size_t k = 0; k < 4; ++k) result.corner[k] = found.simplex.corner[k].w;
  return result;
}

FCL_STPBV_VECTORIZED
Vector3d vertexDifference(const BodyPair& pair, const Vector3d& n) {
  const VertexDifference difference(pair, n);
  return difference.difference(difference.vertex());
}

}  // namespace fcl_stpbv::detail
