// The best ways to cut a part in two.
// 1. Make the two hulls for every plane of cutPlanes() and sort the planes by the hulls' total volume.
// 2. Measure the excess of the halves of the first planes. Stop measuring a plane when one half alone is
//    worse than the best scores so far.
// 3. Keep the two planes with the least volume and, of the others, the two with the best score.
#include "fcl_stpbv/parts/part_cuts.h"

#include <algorithm>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/parts/cut_planes.h"

namespace fcl_stpbv::detail {

const std::vector<PartCut>& PartCuts::of(const PartPtr& part, bool quick, long& spent) {
  constexpr std::size_t kByVolume = 2, kByScore = 2;
  // Planes that are looked at; the other halves have more volume.
  const std::size_t scored = quick ? 4 : 48;
  const auto [place, isNew] = cuts_.try_emplace(part.get());
  std::vector<PartCut>& ways = place->second;
  if (!isNew) return ways;
  kept_.push_back(part);
  const std::vector<CutPlane> planes = cutPlanes(*part, space_);
  std::vector<std::pair<CutHulls, std::size_t>> byVolume;
  for (std::size_t i = 0; i < planes.size(); ++i)
    if (auto hulls = hullsOfCut(*part, planes[i], space_)) byVolume.push_back({*std::move(hulls), i});
  const auto lessVolume = [](const auto& a, const auto& b) { return a.first.volume < b.first.volume; };
  const auto lessScore = [](const PartCut& a, const PartCut& b) { return a.score < b.score; };
  std::stable_sort(byVolume.begin(), byVolume.end(), lessVolume);
  if (byVolume.size() > scored) byVolume.resize(scored);
  spent += static_cast<long>(planes.size());
  std::vector<PartCut> best;  // by score
  double lastVolume = -1;
  for (auto& [hulls, i] : byVolume) {
    const double volume = hulls.volume;
    const bool another =
        volume > lastVolume * (1 + 1e-3);  // planes of nearly one place have nearly one volume
    const bool kept = ways.size() < kByVolume && another;
    const double left = part->hull.volume > 0 ? volume / part->hull.volume : 1, weight = 0.5 + 0.5 * left;
    const double bar = best.size() < kByScore ? kInfinity : best.back().score;
    auto [above, below] = cut(*part, planes[i], space_);
    if (above.empty() || below.empty()) continue;
    // A half that is worse than the bar allows rules the plane out.
    const Measure measure{kCutResolution * excessOf(part), kept ? kInfinity : bar / weight};
    const auto up =
        std::make_shared<Part>(makePart(std::move(above), std::move(hulls.above), space_, measure));
    ++spent;
    if (excessOf(up) > measure.enough) continue;
    const auto down =
        std::make_shared<Part>(makePart(std::move(below), std::move(hulls.below), space_, measure));
    ++spent;
    const auto [less, more] = std::minmax({excessOf(up), excessOf(down)});
    const PartCut split{(more + 0.5 * less) * weight + 1e-5 * space_.size * left, up, down};
    if (kept) {
      ways.push_back(split);
      lastVolume = volume;
    } else if (split.score < bar) {
      if (best.size() == kByScore) best.pop_back();
      best.insert(std::upper_bound(best.begin(), best.end(), split, lessScore), split);
    }
  }
  ways.insert(ways.end(), best.begin(), best.end());
  std::sort(ways.begin(), ways.end(), lessScore);
  return ways;
}

}  // namespace fcl_stpbv::detail
