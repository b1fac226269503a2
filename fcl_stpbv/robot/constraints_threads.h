// How the rows of CollisionConstraints are shared out among threads.
#pragma once

#include "fcl_stpbv/robot/constraints.h"
#include "fcl_stpbv/robot/worker_pool.h"

namespace fcl_stpbv {

/// Every n-th row for each thread, so that far and near ones are shared out.
template <class Work>
void CollisionConstraints::eachPair(const Work& work) {
  auto share = [&](int k) {
    const std::size_t step = static_cast<std::size_t>(pool_->threads());
    for (std::size_t row = static_cast<std::size_t>(k); row < pairs_.size(); row += step) work(row);
  };
  pool_->run(share);
}

}  // namespace fcl_stpbv
