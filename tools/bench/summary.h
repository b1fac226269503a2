// The figures that say in one line how fast and how accurate the solver is.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

namespace fcl_stpbv::benchmark {

struct Summary {
  nlohmann::ordered_json figures;
  double spread = 0;  ///< of the widest of the measured ratios' blocks
  int checked = 0, unproven = 0,
      failed = 0;  ///< queries against the reference; without one; without an answer
};

Summary summarise(std::uint64_t seed);

}  // namespace fcl_stpbv::benchmark
