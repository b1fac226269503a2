// What a motion of bodies is asked, and what comes of it.
#pragma once

namespace fcl_stpbv {

/// What became of a motion.
enum class MotionVerdict {
  free,       ///< proven: at no time does a pair come within the margin
  contact,    ///< one does, first between `from` and `until`
  undecided,  ///< free until `from`; about there the distance is the margin to rounding, or it took too many
              ///< queries
};

/// What is asked about a motion.
struct MotionRequest {
  double margin = 0;          ///< a distance not above it is a contact (m)
  double tolerance = 1e-4;    ///< of the time of contact; 1 for any contact instead of the first
  long mostQueries = 200000;  ///< then undecided
};

/// What becomes of pairs over the time from 0 to 1.
struct MotionBracket {
  MotionVerdict verdict = MotionVerdict::free;  ///< of all pairs together
  double from = 1;                              ///< proven free before it
  double until = 1;                             ///< in contact at it; 1 for a free motion
  int pair = -1;                                ///< the one in contact, or not decided
  long queries = 0;                             ///< distances asked for
};

}  // namespace fcl_stpbv
