// The whole suite: every method on every situation, judged.
#pragma once

#include <nlohmann/json.hpp>

#include "test/reference/stability/judge.h"

namespace fcl_stpbv::stability {

struct Results {
  std::vector<Situation> situations;
  std::vector<Method> methods;
  std::vector<std::vector<Judgement>> of;  ///< by method, then by situation
};

/// Runs everything; methods whose id is not in `only` stay away unless that is empty.
Results runSuite(std::vector<Situation> situations, const std::vector<std::string>& only = {});

/// {"cases": N, "failures": {id: count}}
nlohmann::ordered_json summary(const Results& results);

std::string markdown(const Results& results);                       ///< the tables of docs/stability.md
std::string csv(const Results& results);                            ///< a row a case, a column a method
std::string strip(const Results& results, const std::string& svg);  ///< gnuplot's commands for the picture

}  // namespace fcl_stpbv::stability
