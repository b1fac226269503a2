// Why a pair of links is checked or left out, in MoveIt's words and beyond.
#pragma once

namespace fcl_stpbv {

/// Why a pair of links is checked, or left out.
enum class PairReason {
  sometimes,      ///< collides in some configuration, which is given; to be checked
  adjacent,       ///< on either side of one joint
  rigid,          ///< no joint can change where the two are to each other
  byDefault,      ///< collides in the neutral configuration and wherever else it was looked for
  defaultClears,  ///< collides in the neutral configuration and is clear in another; to be checked
  always,         ///< collides in nearly every sample
  user,           ///< left out by the user's SRDF
  neverSampled,   ///< no collision in any sample, nor in descents
  neverProven,    ///< no collision within the joint limits
};

/// For people and reports: "never (proven)" and the like.
const char* reasonText(PairReason reason);

/// Whether a pair is checked where no SRDF says so: all but adjacent, rigid, byDefault, always and user.
bool checkedWithoutSrdf(PairReason reason);

}  // namespace fcl_stpbv
