// The search for few parts that keep close to the mesh.
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "fcl_stpbv/parts/part.h"

namespace fcl_stpbv::detail {

/// Cuts the worst part again and again, in several lines of cuts at once, since those that lower the excess
/// most are rarely those that look best at first; cuts into more parts than asked for and joins those whose
/// common hull is least far from the mesh; then cuts and joins on while it helps, from several starts where
/// one is not near enough. What was measured once is remembered.
class PartSearch {
 public:
  using Parts = std::vector<PartPtr>;

  /// `work` is the number of hulls to spend.
  PartSearch(const PartSpace& space, long work) : space_(space), work_(work) {}

  /// From parts that cover all: at most `most`, as few of them as found once their excess is within `bound`.
  Parts fewParts(const Parts& start, int most, double bound);

 private:
  struct Split {
    double score;
    PartPtr up, down;
  };
  /// Parts that together cover all, and what tells good ones.
  struct Line {
    Parts parts;
    double worst = 0, volume = 0;
  };
  Line line(Parts parts) const;
  const std::vector<Split>& splits(const PartPtr& part);
  std::vector<Line> cutOn(const std::vector<Line>& beam);
  PartPtr join(const PartPtr& a, const PartPtr& b, double worst);
  Parts joined(Parts parts, int most, double bound);
  Parts byBeam(const Parts& start, int most, double bound);
  Parts byBestCuts(Parts parts, int most, double bound);
  Parts improved(Parts parts, int most, double bound);
  bool exhausted() const { return spent_ >= work_; }

  const PartSpace& space_;
  long work_, spent_ = 0;
  std::map<const Part*, std::vector<Split>> splits_;
  std::map<std::pair<const Part*, const Part*>, PartPtr> joins_;
  Parts kept_;  // all that were looked at, so that no two ever share an address
};

}  // namespace fcl_stpbv::detail
