// What earlier measures found out about single triangles of hulls: the hulls that a search for parts measures
// share most of their triangles.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <unordered_map>
#include <vector>

#include "fcl_stpbv/parts/mesh_solid.h"
#include "fcl_stpbv/vector_hash.h"

namespace fcl_stpbv::detail {

/// A piece of a hull's triangle, and a bound on its points' distances from the mesh (m).
struct OpenPiece {
  double bound;
  Triangle corners;
  int near;              ///< a triangle of the mesh that is probably near, or -1
  std::size_t root = 0;  ///< the hull's triangle that it is a piece of
  bool operator<(const OpenPiece& other) const { return bound < other.bound; }
};

/// The excess of one triangle, as far as it is known.
struct TriangleExcess {
  bool isKnown = false;            ///< it was measured
  double lower = 0;                ///< certified (m)
  Eigen::Vector3d where{0, 0, 0};  ///< a point at that distance
  double settled = 0;              ///< bound on all pieces but the open ones (m)
  std::vector<OpenPiece> open;     ///< pieces to go on with

  double upper() const {
    double most = settled;
    for (const OpenPiece& piece : open) most = std::max(most, piece.bound);
    return most;
  }
};

/// The triangles measured last, for one mesh.
class KnownExcess {
 public:
  /// Before each hull: forgets all where it has become too much to keep.
  void makeRoom() {
    constexpr std::size_t kMostTriangles = 100000, kMostPieces = 200000;  // 20 MB each
    if (known_.size() < kMostTriangles && pieces_ < kMostPieces) return;
    known_.clear();
    pieces_ = 0;
  }
  /// What is known of a triangle. It stays where it is until makeRoom().
  TriangleExcess& of(const Triangle& t) {
    Triangle key = t;  // the least corner first
    const auto less = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    };
    std::rotate(key.begin(), std::min_element(key.begin(), key.end(), less), key.end());
    return known_[key];
  }
  /// Counts pieces that a triangle keeps.
  void addPieces(std::size_t count) { pieces_ += count; }

 private:
  struct Hash {
    std::size_t operator()(const Triangle& t) const {
      std::size_t seed = 0;
      for (const Eigen::Vector3d& p : t) seed = seed * 1000003u ^ VectorHash()(p);
      return seed;
    }
  };
  std::unordered_map<Triangle, TriangleExcess, Hash> known_;
  std::size_t pieces_ = 0;  // kept since the last time that room was made
};

/// excessOf() of a solid, with what `known` holds of this mesh's triangles, to which it adds.
MeshExcess excessOf(const std::vector<Triangle>& surface, const MeshSolid& mesh, const ExcessOptions& options,
                    KnownExcess& known);

}  // namespace fcl_stpbv::detail
