// Candidate planes for cutting a part, and the best ways to cut it in two.
#pragma once

#include <map>
#include <vector>

#include "fcl_stpbv/parts/part.h"

namespace fcl_stpbv::detail {

/// The planes of the mesh's flat parts. `facetOf` receives for each triangle the index of its flat part.
std::vector<CutPlane> flatParts(const MeshSolid& mesh, double slack, std::vector<int>& facetOf);

/// The planes are perpendicular to the coordinate axes and the part's principal axes, in even steps; through
/// the point that is farthest from the mesh; and along the largest flat parts of the mesh, which often are
/// the faces that make a designed body concave.
std::vector<CutPlane> cutPlanes(const Part& part, const PartSpace& space);

/// The excess of a part, as far as it is known (m).
inline double excessOf(const PartPtr& part) { return part->excess.lower; }

/// Resolution with which a cut's halves are measured, as a share of the excess of the part that is cut.
constexpr double kCutResolution = 0.15;

struct PartCut {
  double score;  ///< of excess and volume, the less the better
  PartPtr up, down;
};

/// Finds them once for each part.
class PartCuts {
 public:
  explicit PartCuts(const PartSpace& space) : space_(space) {}

  /// The best four ways: two by a score of excess and volume, and among the others two by volume alone, which
  /// tells a useful cut before the excess does. Where it must be `quick`, few planes are tried. Adds the
  /// number of hulls to `spent`.
  const std::vector<PartCut>& of(const PartPtr& part, bool quick, long& spent);

 private:
  const PartSpace& space_;
  std::map<const Part*, std::vector<PartCut>> cuts_;
  std::vector<PartPtr> kept_;  // the parts in cuts_, so that addresses stay unique
};

}  // namespace fcl_stpbv::detail
