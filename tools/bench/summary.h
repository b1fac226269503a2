// The figures that summarise how fast and how accurate the solver is.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

namespace fcl_stpbv::benchmark {

struct Summary {
  nlohmann::ordered_json figures;
  double spread = 0;  ///< spread of the ratio whose blocks differ most
  /// Numbers of queries: compared with the reference; without a proven reference; without an answer.
  int checked = 0, unproven = 0, failed = 0;
};

Summary summarise(std::uint64_t seed);

}  // namespace fcl_stpbv::benchmark
