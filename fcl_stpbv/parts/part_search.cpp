// Search for few convex parts with small excess, by cuts:
// 1. Beam search. The worst part is cut in four ways: the two with the least volume and the two with the best
//    score of excess and volume. Of all resulting sets, the two with the least excess and the two with the
//    least volume continue. If there are more parts than requested, the two whose common hull has the least
//    excess are joined.
// 2. Local search: cut and join again while that makes the worst parts better.
// 3. If the excess is still too large, local search from two other starts: many parts by greedy cuts, joined
//    again; and the uncut mesh, first with half as many parts. The best result counts; `work` limits it all.
// 4. More than eight parts: start from eight, cut the worst part in the best way each time, and improve by
//    local search. Repeat for twice as many, up to the number requested. So the excess is never larger than
//    with eight. Each round may use `work`.
#include "fcl_stpbv/parts/part_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {
namespace {

constexpr long kStep = 20;        // hulls that a step counts for at least, so that each search ends
constexpr long kConfirm = 10000;  // distances to know what the search goes on with
constexpr long kJudge = 100000;   // distances to know whether a part is within the bound

std::size_t worstOf(const PartSearch::Parts& parts) {
  const auto less = [](const PartPtr& a, const PartPtr& b) { return excessOf(a) < excessOf(b); };
  return static_cast<std::size_t>(std::max_element(parts.begin(), parts.end(), less) - parts.begin());
}

// Number of parts to cut into before they are joined to at most `most`. If `most` is 2 or 3, many parts are
// not worth the time.
std::size_t manyParts(int most) {
  return static_cast<std::size_t>(std::max({most, most < 4 ? 2 * most : 16, std::min(2 * most, 24)}));
}

}  // namespace

double PartSearch::worstExcess(const Parts& parts) { return excessOf(parts[worstOf(parts)]); }

bool PartSearch::isEnough(const Parts& parts) const {
  return parts.size() <= static_cast<std::size_t>(most_) && isWithin(parts);
}

bool PartSearch::isBetter(const Parts& a, const Parts& b) {
  const auto worstFirst = [](const Parts& parts, std::size_t size) {
    std::vector<double> excess;
    for (const PartPtr& part : parts) excess.push_back(excessOf(part));
    std::sort(excess.begin(), excess.end(), std::greater<>());
    excess.resize(size);
    return excess;
  };
  const std::size_t most = std::max(a.size(), b.size());
  const std::vector<double> first = worstFirst(a, most), second = worstFirst(b, most);
  for (std::size_t i = 0; i < most; ++i)
    if (std::abs(first[i] - second[i]) > 0.01 * second.front()) return first[i] < second[i];
  return false;
}

PartSearch::Line PartSearch::line(Parts parts) const {
  Line out;
  out.worst = worstExcess(parts);
  for (const PartPtr& part : parts) {  // a part that was not measured well may turn out the worst
    const double needed = std::max(0.05 * out.worst, 0.5 * space_.fine);
    if (part->excess.upper > 1.2 * out.worst + space_.fine && needed < 0.7 * part->resolution)
      measureAgain(*part, space_, {needed});
    out.worst = std::max(out.worst, excessOf(part));
  }
  for (const PartPtr& part : parts) out.volume += part->hull.volume;
  out.parts = std::move(parts);
  return out;
}

// For many parts the excess is only a lower bound. Parts that may be the worst are measured again,
// accurately.
void PartSearch::confirm(const Parts& parts) const {
  const double worst = std::max(worstExcess(parts), space_.fine);
  for (const PartPtr& part : parts)
    if (part->excess.upper > 1.2 * worst + space_.fine && part->queries < kConfirm)
      measureAgain(*part, space_, {std::max(0.05 * worst, 0.5 * space_.fine), kInfinity, kConfirm});
}

// If a part may or may not be within the bound, it is measured until that is known, because a result that
// turns out to be a little too far from the mesh would have to be searched for again.
bool PartSearch::isWithin(Part& part, double bound) const {
  const bool open = part.excess.lower <= bound && part.excess.upper > bound;
  if (open && bound > space_.fine && part.judged != bound) {
    measureAgain(part, space_, {std::max(0.002 * bound, 0.1 * space_.fine), bound, kJudge, 0});
    part.judged = bound;
  }
  return part.excess.lower <= bound;
}

bool PartSearch::isWithin(const Parts& parts) const {
  if (worstExcess(parts) > bound_) return false;
  return std::all_of(parts.begin(), parts.end(),
                     [&](const PartPtr& part) { return isWithin(*part, bound_); });
}

// Their common hull, its excess known up to `measure.enough`: far from the mesh it is found out soon.
PartPtr PartSearch::join(const PartPtr& a, const PartPtr& b, const Measure& measure) {
  PartPtr& found = joins_[std::minmax(a.get(), b.get())];
  if (!found) {
    found = std::make_shared<Part>(detail::joined(*a, *b, space_, measure));
    kept_.push_back(a);
    kept_.push_back(b);
    ++spent_;
  } else if (!std::isfinite(found->excess.upper) && excessOf(found) < measure.enough) {
    measureAgain(*found, space_, measure);  // the excess was above `enough` in the earlier measurement
  }
  return found;
}

// Joins the two parts whose common hull has the least excess, until few parts are left and no join is within
// the bound.
PartSearch::Parts PartSearch::joined(Parts parts, int most, double bound) {
  while (parts.size() > 1) {
    const bool few = parts.size() <= static_cast<std::size_t>(most);
    double best = few ? bound : kInfinity;  // bound on the excess of the next join
    PartPtr both;
    std::size_t first = 0, second = 0;
    const double worst = worstExcess(parts);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      for (std::size_t k = i + 1; k < parts.size(); ++k) {
        const PartPtr tried = join(parts[i], parts[k], {kCutResolution * worst, best});
        if (both ? excessOf(tried) >= best : excessOf(tried) > best) continue;
        best = excessOf(tried), both = tried, first = i, second = k;
      }
    }
    if (!both) break;
    if (few && both->excess.upper > bound + space_.fine && both->queries < kConfirm) {
      measureAgain(*both, space_, {0.5 * space_.fine, kInfinity, kConfirm});
      continue;  // it may turn out not to be within the bound
    }
    if (few && !isWithin(*both, bound)) continue;
    parts[first] = both;
    parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(second));
  }
  return line(std::move(parts)).parts;
}

// Makes one more part in each line: tries the ways to cut the worst part. The lines with the least excess and
// those with the least volume continue.
std::vector<PartSearch::Line> PartSearch::cutOn(const std::vector<Line>& beam) {
  constexpr std::size_t kEach = 2;
  std::vector<Line> next;
  for (const Line& old : beam) {
    const std::size_t w = worstOf(old.parts);
    for (const PartCut& split : cuts_.of(old.parts[w], exhausted(), spent_)) {
      Parts parts = old.parts;
      parts[w] = split.up;
      parts.push_back(split.down);
      next.push_back(line(std::move(parts)));
    }
  }
  const auto key = [](const Line& l) { return std::tie(l.worst, l.volume); };
  std::sort(next.begin(), next.end(), [&](const Line& a, const Line& b) { return key(a) < key(b); });
  const auto same = [&](const Line& a, const Line& b) { return key(a) == key(b); };
  next.erase(std::unique(next.begin(), next.end(), same), next.end());
  if (next.size() <= 2 * kEach) return next;
  const auto middle = next.begin() + kEach;
  std::sort(middle, next.end(), [](const Line& a, const Line& b) { return a.volume < b.volume; });
  next.resize(2 * kEach);
  return next;
}

PartSearch::Parts PartSearch::improved(Parts parts, int most) {
  confirm(parts);
  while (!exhausted() && !isWithin(parts)) {
    spent_ += kStep;
    Parts best = parts;
    std::vector<Line> beam{line(parts)};
    for (int more = 0; more < 2; ++more) {
      beam = cutOn(beam);
      for (const Line& tried : beam) {
        Parts few = joined(tried.parts, most, 0.5 * bound_);
        if (!isBetter(few, best)) continue;
        confirm(few);
        if (isBetter(few, best)) best = std::move(few);
      }
    }
    if (best == parts) break;
    parts = std::move(best);
  }
  return parts;
}

PartSearch::Parts PartSearch::improved(const Parts& parts, long work) {
  work_ = spent_ + work;
  return joined(improved(joined(parts), most_));
}

PartSearch::Parts PartSearch::byBeam(const Parts& start, int most) {
  Parts best = joined(start, most, 0);
  std::vector<Line> beam{line(start)};
  while (!beam.empty() && !isWithin(best) && beam.front().parts.size() < manyParts(most)) {
    if (exhausted() || beam.front().parts.size() >= at(most))
      beam.resize(1);  // only the best line goes on, up to manyParts()
    beam = cutOn(beam);
    for (const Line& tried : beam) {
      const bool few = tried.parts.size() <= at(most);
      if (!few && exhausted()) continue;
      Parts parts = few ? tried.parts : joined(tried.parts, most, 0.5 * bound_);
      if (worstExcess(parts) < worstExcess(best)) best = std::move(parts);
    }
  }
  return best;
}

PartSearch::Parts PartSearch::byBestCuts(Parts parts, int most) {
  while (!exhausted() && !isWithin(parts) && parts.size() < manyParts(most)) {
    const std::size_t w = worstOf(parts);
    const std::vector<PartCut>& ways = cuts_.of(parts[w], exhausted(), spent_);
    if (ways.empty()) break;
    parts[w] = ways.front().up;
    parts.push_back(ways.front().down);
  }
  return joined(std::move(parts), most, 0.5 * bound_);
}

PartSearch::Parts PartSearch::fewByCuts(const Parts& start, int most) {
  Parts best = improved(byBeam(start, most), most);
  const auto another = [&](Parts from) {
    Parts found = improved(std::move(from), most);
    if (isBetter(found, best)) best = std::move(found);
  };
  const auto goesOn = [&] { return !exhausted() && !isWithin(best); };
  if (goesOn()) another(byBestCuts(start, most));
  if (goesOn()) {
    const int half = most < 4 ? most : most / 2;
    another(half == most ? joined(start, half, 0) : improved(joined(start, half, 0), half));
  }
  return best;
}

PartSearch::Parts PartSearch::byCuts(const Parts& start, long work) {
  constexpr int kFew = 8;  // up to this number of parts, all four ways to cut are followed
  int most = std::min(most_, kFew);
  work_ = spent_ + work;
  Parts best = fewByCuts(start, most);
  while (most < most_ && !isWithin(best)) {
    most = std::min(most_, 2 * most);
    work_ = spent_ + work;
    Parts more = improved(byBestCuts(best, most), most);
    if (isBetter(more, best)) best = std::move(more);
  }
  return joined(best);
}

}  // namespace fcl_stpbv::detail
