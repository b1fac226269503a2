// The search for a few convex parts with small excess over the mesh: by cuts and joins, and by joining the
// mesh's facets (flat parts) with their neighbours; and the parts' growth until they cover the inside.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "fcl_stpbv/parts/part.h"
#include "fcl_stpbv/parts/part_cuts.h"

namespace fcl_stpbv::detail {

/// Repeatedly cuts the worst part, and follows several sequences of cuts at once (beam search), because the
/// cuts that lower the excess most in the end are rarely those that look best at first. Cuts into more parts
/// than requested, and joins those whose common hull has the least excess. Then cuts and joins again as long
/// as that helps (local search). All measurements are cached.
class PartSearch {
 public:
  using Parts = std::vector<PartPtr>;

  /// For at most `most` parts.
  PartSearch(const PartSpace& space, int most) : space_(space), most_(most), cuts_(space) {}

  /// Sets the goal: as few parts as possible with an excess within `bound` (m). The cached measurements stay
  /// valid.
  void aim(double bound) { bound_ = std::max(bound, space_.fine); }

  /// Cuts parts that cover the whole mesh. `work` is the number of hulls that may be made, and again as many
  /// each time that the number of parts may double.
  Parts byCuts(const Parts& start, long work);
  /// The same parts, joined to few, then cut and joined further as long as that makes the worst of them
  /// better. `work` is the number of hulls that may be made.
  Parts improved(const Parts& parts, long work);

  /// The largest excess of a part, as far as it was measured (m).
  static double worstExcess(const Parts& parts);
  /// Whether the search would end with these parts.
  bool isEnough(const Parts& parts) const;
  /// Compares the worst parts, with a tolerance of 1 %, then the second worst and so on. This is needed
  /// because a step can improve only one of two equally bad parts.
  static bool isBetter(const Parts& a, const Parts& b);

 private:
  /// A set of parts that together cover the mesh, and measures of its quality.
  struct Line {
    Parts parts;
    double worst = 0, volume = 0;
  };
  Line line(Parts parts) const;
  void confirm(const Parts& parts) const;
  bool isWithin(Part& part, double bound) const;
  bool isWithin(const Parts& parts) const;
  std::vector<Line> cutOn(const std::vector<Line>& beam);
  PartPtr join(const PartPtr& a, const PartPtr& b, const Measure& measure);
  Parts joined(Parts parts, int most, double bound);
  Parts joined(const Parts& parts) { return joined(parts, most_, bound_); }
  Parts byBeam(const Parts& start, int most);
  Parts byBestCuts(Parts parts, int most);
  Parts fewByCuts(const Parts& start, int most);
  Parts improved(Parts parts, int most);
  bool exhausted() const { return spent_ >= work_; }

  const PartSpace& space_;
  int most_;
  double bound_ = 0;
  long work_ = 0, spent_ = 0;
  PartCuts cuts_;
  std::map<std::pair<const Part*, const Part*>, PartPtr> joins_;
  Parts kept_;  // the parts in joins_, so that addresses stay unique
};

constexpr std::size_t kSearched = 2500;  ///< largest number of triangles that the search works on

/// The mesh's triangles in groups: one group per piece if `each`, otherwise one group. `facetOf`: index of
/// each triangle's facet.
std::vector<TriangleSoup> meshGroups(const MeshSolid& mesh, const std::vector<int>& facetOf, bool each);

/// At most about kSearched triangles that replace those of a group.
TriangleSoup forSearch(const TriangleSoup& soup, const PartSpace& space);

/// Joins connected facets with neighbours as long as the common hull is within `bound` (m) of the mesh, and
/// further until `most` parts are left. Returns the sets of parts on the way, each a little coarser than the
/// one before. Each set contains all triangles. The caller must prove that it also covers the inside of the
/// mesh. Empty if the mesh has too many facets or loose pieces.
std::vector<PartSearch::Parts> facetParts(const std::vector<TriangleSoup>& groups, const PartSpace& space,
                                          int most, double bound);

/// Takes parts whose hulls contain all of the mesh's triangles. Grows them or adds parts, up to `most`, until
/// they contain the inside of the mesh too. Empty if that would need a part farther from the mesh than
/// `bound` (m), or too many steps.
PartSearch::Parts filled(PartSearch::Parts parts, const PartSpace& space, int most, double bound);

}  // namespace fcl_stpbv::detail
