// The transition of rows from the distance to a constant: for all rows far away, and for the hand-over
// between rows of whole bodies and rows of their convex parts.
//
// Parts lie inside their whole bodies, so their distance is never smaller. While the whole bodies are farther
// apart than the hand-over distance, the row of each part is constant and needs no query. Each row is a
// function of its own distance only, so its derivatives follow by the chain rule.
#include <limits>
#include <map>
#include <tuple>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/constraints.h"

namespace fcl_stpbv {
namespace {

using namespace detail;

/// A function of the distance with its derivatives.
struct Bent {
  double value, slope, curvature;
};

// The constant value from `end` on of a distance that levels off from `start` to `end`.
double levelAt(double start, double end) { return (start + end) / 2; }

// The distance itself up to `start`, constant from `end` on. The slope falls as a cubic in between, so the
// function is C2.
Bent levelOff(double d, double start, double end) {
  if (!(d > start)) return {d, 1, 0};
  if (d >= end) return {levelAt(start, end), 0, 0};
  const double width = end - start, t = (d - start) / width;
  return {start + width * (t - t * t * t * (1 - t / 2)), 1 - t * t * (3 - 2 * t), 6 * t * (t - 1) / width};
}

}  // namespace

// For a row of whole bodies: the distance minus the transition function of its parts' rows, plus that
// function's final value. So it is constant where the parts' rows are exact, and equals the distance where
// they are constant.
double CollisionConstraints::levelled(std::size_t row, double d, double& slope, double& curvature) const {
  const Row& r = rows_[row];
  const bool unknown = d == std::numeric_limits<double>::lowest();
  Bent bent = levelOff(d, options_.exactUpTo, options_.influence);
  if (r.group >= 0 && !unknown) {
    const Bent part = levelOff(d, r.start, r.end);
    const double level = levelAt(r.start, r.end);
    if (!r.whole)
      bent = part;
    else if (d > r.start)
      bent = {bent.value + (level - part.value), bent.slope - part.slope, bent.curvature - part.curvature};
    else
      bent = {level, 0, 0};
  }
  slope = bent.slope;
  curvature = bent.curvature;
  return bent.value;
}

double CollisionConstraints::exactUpTo(int row) const {
  requireRow(row);
  if (at(row) >= pairs_.size()) return kInfinity;
  const Row& r = rows_[at(row)];
  return r.group >= 0 && !r.whole ? r.start : options_.exactUpTo;
}

// Puts a pair of whole bodies before the first of two or more pairs of their parts.
void CollisionConstraints::addWholePairs() {
  groupOf_.assign(pairs_.size(), -1);
  if (options_.handOver == kInfinity) return;
  const std::vector<Body>& bodies = geometry_->bodies;
  const auto wholeOf = [&](int body) {
    return at(body) < bodies.size() && bodies[at(body)].partOf >= 0 ? bodies[at(body)].partOf : body;
  };
  const auto keyOf = [&](const CheckedPair& pair) {
    return std::tuple(wholeOf(pair.body), pair.obstacle ? pair.other : wholeOf(pair.other), pair.obstacle);
  };
  // A reduced volume may not contain the volumes of the mesh's parts.
  const auto holdsItsParts = [&](int body) {
    return at(body) < bodies.size() && !bodies[at(body)].isReduced();
  };
  const auto handsOver = [&](const CheckedPair& pair) {
    const auto [a, b, obstacle] = keyOf(pair);
    return (a != pair.body || b != pair.other) && holdsItsParts(a) && (obstacle || holdsItsParts(b));
  };
  std::map<std::tuple<int, int, bool>, int> count, group;
  for (const CheckedPair& pair : pairs_)
    if (handsOver(pair)) ++count[keyOf(pair)];
  std::vector<CheckedPair> all;
  groupOf_.clear();
  for (const CheckedPair& pair : pairs_) {
    int mine = -1;
    if (handsOver(pair) && count[keyOf(pair)] > 1) {
      const auto [found, isNew] = group.try_emplace(keyOf(pair), static_cast<int>(wholeRow_.size()));
      mine = found->second;
      if (isNew) {
        const auto [a, b, obstacle] = keyOf(pair);
        wholeRow_.push_back(all.size());
        all.push_back({a, b, obstacle});
        groupOf_.push_back(mine);
      }
    }
    all.push_back(pair);
    groupOf_.push_back(mine);
  }
  pairs_ = std::move(all);
  whole_.resize(wholeRow_.size());
}

void CollisionConstraints::askWhole() {
  for (std::size_t i = 0; i < wholeRow_.size(); ++i) whole_[i] = query(wholeRow_[i]);
}

CollisionConstraints::Witness CollisionConstraints::ask(std::size_t row) {
  const Row& r = rows_[row];
  if (r.group < 0) return query(row);
  if (r.whole) return whole_[at(r.group)];
  if (!(whole_[at(r.group)].distance >= r.end)) return query(row);
  found_[row].status = answers_[row].status = DistanceStatus::invalid;
  found_[row].distance = answers_[row].distance = r.end;
  return known(row);
}

}  // namespace fcl_stpbv
