// The words for why a pair is checked or left out, and which of them count without an SRDF.
#include "fcl_stpbv/robot/pair_list.h"

namespace fcl_stpbv {

const char* reasonText(PairReason reason) {
  switch (reason) {
    case PairReason::sometimes:
      return "sometimes";
    case PairReason::adjacent:
      return "adjacent";
    case PairReason::rigid:
      return "rigid";
    case PairReason::byDefault:
      return "default";
    case PairReason::defaultClears:
      return "default (clears elsewhere)";
    case PairReason::always:
      return "always";
    case PairReason::user:
      return "user";
    case PairReason::neverSampled:
      return "never (sampled)";
    case PairReason::neverProven:
      return "never (proven)";
  }
  return "";
}

bool checkedWithoutSrdf(PairReason reason) {
  return reason != PairReason::adjacent && reason != PairReason::rigid && reason != PairReason::byDefault &&
         reason != PairReason::user;
}

}  // namespace fcl_stpbv
