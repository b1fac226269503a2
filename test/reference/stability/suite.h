// The whole suite: every method on every situation, with verdicts.
#pragma once

#include <nlohmann/json.hpp>

#include "test/reference/stability/judge.h"

namespace fcl_stpbv::stability {

struct Results {
  std::vector<Situation> situations;
  std::vector<Method> methods;
  std::vector<std::vector<Judgement>> of;  ///< by method, then by situation
};

/// Runs everything. If `only` is not empty, only methods with these ids are run.
Results runSuite(std::vector<Situation> situations, const std::vector<std::string>& only = {});

/// {"cases": N, "failures": {id: count}}
nlohmann::ordered_json summary(const Results& results);

/// One row per case: group, case, placements, and each method's verdict and amount in the order of
/// `methodNames`.
std::vector<nlohmann::ordered_json> caseRows(const Results& results);
/// [{"id", "title"}] of the methods.
nlohmann::ordered_json methodNames(const Results& results);

}  // namespace fcl_stpbv::stability
