// The search for a few convex parts with small excess over the mesh.
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

}  // namespace fcl_stpbv::detail
