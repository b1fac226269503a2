// Finds the first contact of moving pairs, or proves that there is none, by bisection of the time, earlier
// half first.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "fcl_stpbv/adapter/continuous_collide.h"
#include "fcl_stpbv/adapter/moving_bodies.h"

namespace fcl_stpbv::detail {

/// `scene.place(t)` moves all bodies to their poses at time t. Then `scene.look(pair, most, cover)` returns
/// whether the pair is in contact. If not, it fills `cover`: the times before and after t, each at most
/// `most`, for which the pair is proven clear.
///
/// For each interval, every pair that is undecided there is examined at the middle. The parts that its cover
/// leaves open are examined in the earlier and the later half. All times before the current interval are
/// already proven for all pairs. So the first contact that is bracketed to the tolerance is the first of all.
template <class Scene>
class MotionSearch {
 public:
  MotionSearch(Scene& scene, const MotionRequest& request) : scene_(scene), request_(request) {
    if (!(request_.tolerance >= kFinest)) request_.tolerance = kFinest;
  }

  MotionBracket run(int pairs) {
    result_ = {};
    constexpr long kForEach = 1000;
    most_ = std::max(request_.mostQueries, kForEach * pairs);
    hit_ = std::numeric_limits<double>::infinity();
    lists_.resize(static_cast<std::size_t>(pairs));
    for (std::size_t i = 0; i < lists_.size(); ++i) lists_[i] = static_cast<int>(i);
    // A contact that was found is final, even if the covers of other times include it.
    if (pairs > 0 && !visit(0, 1, 0, lists_.size()) && hit_ <= 1)
      finish(MotionVerdict::contact, hit_, hit_, hitPair_);
    return result_;
  }

 private:
  // A shorter time is not divided: in it bodies move only by rounding.
  static constexpr double kFinest = 1e-12;
  // In an interval up to this length the end is examined, too, because a contact may begin there.
  static constexpr double kEnd = 1e-6;

  // Searches the time from `a` to `b` for the pairs lists_[first, last). True if the search is over.
  bool visit(double a, double b, std::size_t first, std::size_t last) {
    b = std::min(b, hit_);
    if (a >= b) return false;
    if (b == hit_ && b - a <= request_.tolerance) return finish(MotionVerdict::contact, a, hit_, hitPair_);
    if (b - a <= std::min(kEnd, request_.tolerance)) {
      const int pair = inContact(b, first, last);
      if (pair >= 0) return finish(MotionVerdict::contact, a, b, pair);
    }
    result_.tooMany = result_.queries > most_;
    if (result_.tooMany) return finish(MotionVerdict::undecided, a, b, lists_[first]);
    const double half = 0.5 * (b - a), middle = a + half;
    Cover least{half, half};
    const std::size_t early = lists_.size();
    scene_.place(middle);
    // Pairs for the later half follow those for the earlier half, once all are known.
    std::size_t late = early;
    later_.clear();
    for (std::size_t i = first; i < last; ++i) {
      const int pair = lists_[i];
      Cover cover;
      ++result_.queries;
      if (scene_.look(pair, half, cover)) {
        cover = {};
        if (middle < hit_) hit_ = middle, hitPair_ = pair;
        if (request_.tolerance >= 1) return finish(MotionVerdict::contact, a, middle, pair);
      }
      if (cover.before < half)
        lists_.push_back(pair), ++late, least.before = std::min(least.before, cover.before);
      if (cover.after < half) later_.push_back(pair), least.after = std::min(least.after, cover.after);
    }
    lists_.insert(lists_.end(), later_.begin(), later_.end());
    const std::size_t end = lists_.size();
    // Only an interval that was examined is called undecided, because two covers may leave a free interval as
    // short as this between them.
    if (end > early && b - a <= kFinest) return finishSoonAfter(a, b, early, end);
    bool over = late > early && visit(a, middle - least.before, early, late);
    if (!over && end > late) over = visit(middle + least.after, b, late, end);
    lists_.resize(early);
    return over;
  }

  // The first of the pairs lists_[first, last) that is in contact at the time, or -1.
  int inContact(double time, std::size_t first, std::size_t last) {
    scene_.place(time);
    for (std::size_t i = first; i < last; ++i) {
      Cover ignored;
      ++result_.queries;
      if (scene_.look(lists_[i], 0, ignored)) return lists_[i];
    }
    return -1;
  }

  // From `a` on the distance equals the margin up to rounding. Within the tolerance it may become a clear
  // contact.
  bool finishSoonAfter(double a, double b, std::size_t first, std::size_t last) {
    const double end = std::min(1.0, a + request_.tolerance);
    if (hit_ <= end) return finish(MotionVerdict::contact, a, hit_, hitPair_);
    for (double time = b; time < end;) {
      time = std::min(end, a + 2 * (time - a));
      const int pair = inContact(time, first, last);
      if (pair >= 0) return finish(MotionVerdict::contact, a, time, pair);
    }
    return finish(MotionVerdict::undecided, a, b, lists_[first]);
  }

  bool finish(MotionVerdict verdict, double from, double until, int pair) {
    result_.verdict = verdict;
    result_.from = from;
    result_.until = until;
    result_.pair = pair;
    return true;
  }

  Scene& scene_;
  MotionRequest request_;
  MotionBracket result_;
  long most_ = 0;   // limit on the number of queries
  double hit_ = 0;  // time of the earliest contact known
  int hitPair_ = -1;
  std::vector<int> lists_, later_;
};

}  // namespace fcl_stpbv::detail
