// What an answer is worth, seen beside the right one.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "test/reference/stability/contestant.h"
#include "test/reference/stability/truth.h"

namespace fcl_stpbv::stability {

/// From best to worst: a case has the verdict of its worst answer.
enum class Verdict {
  exact,      ///< to rounding
  global,     ///< deeper than the margins: no better way out was found by the reference
  local,      ///< deeper than the margins: a way out, said to be only local, and there is a better one
  tolerance,  ///< off by at most kTolerance of the pair's size
  jump,       ///< right answers, between which the gradient jumps
  wrong,      ///< off by more
  none,       ///< no answer where there is one
  nan,
  exception,
  hang,
  abort,
};
constexpr int kVerdicts = 11;
constexpr double kTolerance = 1e-6;

const char* nameOf(Verdict verdict);
inline bool isFailure(Verdict verdict) { return verdict >= Verdict::jump; }

struct Judgement {
  Verdict verdict = Verdict::exact;
  double amount = 0;  ///< wrong and tolerance: metres off; jump: change of the gradient in one step
  int placement = 0;  ///< the first with this verdict

  std::string text() const;  ///< "wrong by 3e-05"
};

/// The right answers to some of a situation's placements, evenly spread, first and last among them.
struct Truths {
  std::vector<int> placement;
  std::vector<SmoothTruth> smooth;
  std::vector<SharpTruth> sharp;
};
Truths truthsOf(const Situation& situation);

/// Judges all answers: those with a known truth by it, a path's also by its steps.
///
/// Off by: the largest of the distance's error; of what the normal's error would make of the
/// distance; of how much the witness points disagree with both. A jump: the gradient of the
/// distance (with respect to the second body's twist) changes in a step by more than it can
/// between STP-BVs of these radii (docs/theory.md, 6).
Judgement judge(const Method& method, const Situation& situation, const Truths& truths,
                const std::vector<Answer>& answers);

}  // namespace fcl_stpbv::stability
