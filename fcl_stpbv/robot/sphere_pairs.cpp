// Compares four pairs at a time in the lanes of a register, and appends the near ones without a branch.
#include "fcl_stpbv/robot/sphere_pairs.h"

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

void SpherePairs::resize(std::size_t pairs) {
  count_ = pairs;
  fours_.assign((pairs + kLanes - 1) / kLanes, Four{});
  near_.resize(pairs + kLanes);
}

void SpherePairs::set(std::size_t pair, std::size_t a, std::size_t b, double reach) {
  Four& four = fours_[pair / kLanes];
  four.a[pair % kLanes] = a;
  four.b[pair % kLanes] = b;
  four.reach[pair % kLanes] = reach;
}

FCL_STPBV_VECTORIZED
void SpherePairs::compare(const std::vector<SphereCentre>& centre, double slack) {
  nearCount_ = 0;
  int pair = 0;
  const int count = static_cast<int>(count_);
  for (const Four& four : fours_) {
    Packed squares[kLanes];
    for (std::size_t k = 0; k < kLanes; ++k) {
      const Packed d = centre[four.b[k]].at - centre[four.a[k]].at;
      squares[k] = d * d;
    }
    const Packed apart2 = sums(squares[0], squares[1], squares[2], squares[3]), reach = four.reach + slack;
    for (std::size_t k = 0; k < kLanes; ++k, ++pair) {
      near_[nearCount_] = {pair, apart2[k]};
      const bool clear = apart2[k] > reach[k] * reach[k] && apart2[k] < kInfinity;
      nearCount_ += !clear && pair < count;
    }
  }
}

}  // namespace fcl_stpbv::detail
