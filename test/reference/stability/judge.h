// Compares an answer with the right one.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "test/reference/stability/contestant.h"
#include "test/reference/stability/truth.h"

namespace fcl_stpbv::stability {

/// From best to worst. The verdict of a case is that of its worst answer.
enum class Verdict {
  exact,      ///< to rounding
  global,     ///< deeper than the margins: the reference found no better way out
  local,      ///< deeper than the margins: a way out that is reported as local, and there is a better one
  tolerance,  ///< off by at most kTolerance of the pair's size
  jump,       ///< right answers, but the gradient jumps between them
  wrong,      ///< off by more than kTolerance
  none,       ///< no answer although there is one
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
  double amount = 0;  ///< wrong and tolerance: error in metres; jump: change of the gradient in one step
  int placement = 0;  ///< the first placement with this verdict

  std::string text() const;  ///< "wrong by 3e-05"
};

/// The right answers to some of a situation's placements, evenly distributed, including the first and the
/// last.
struct Truths {
  std::vector<int> placement;
  std::vector<SmoothTruth> smooth;
  std::vector<SharpTruth> sharp;
};
Truths truthsOf(const Situation& situation);

/// Judges all answers: those whose truth is known by the truth, and a path's also by its steps.
///
/// The error is the largest of: the distance's error; the error of the distance that follows from the
/// normal's; the difference of the witness points from both. A jump: the gradient of the distance (with
/// respect to the second body's twist) changes in a step by more than it can between STP-BVs of these radii
/// (docs/theory.md, 6).
Judgement judge(const Method& method, const Situation& situation, const Truths& truths,
                const std::vector<Answer>& answers);

}  // namespace fcl_stpbv::stability
