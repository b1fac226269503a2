// 1. Compute the truths of all situations.
// 2. Get each method's answers, from child processes.
// 3. Judge each answer, and count failures.
#include "test/reference/stability/suite.h"

#include <algorithm>

#include "test/reference/stability/isolated.h"

namespace fcl_stpbv::stability {

Results runSuite(std::vector<Situation> situations, const std::vector<std::string>& only) {
  Results results;
  results.situations = std::move(situations);
  for (const Method& method : allMethods())
    if (only.empty() || std::find(only.begin(), only.end(), method.id) != only.end())
      results.methods.push_back(method);
  std::vector<Truths> truths;
  for (const Situation& s : results.situations) truths.push_back(truthsOf(s));
  for (const Method& method : results.methods) {
    const std::vector<std::vector<Answer>> answers = answersOf(method, results.situations);
    std::vector<Judgement>& judged = results.of.emplace_back();
    for (std::size_t i = 0; i < answers.size(); ++i)
      judged.push_back(judge(method, results.situations[i], truths[i], answers[i]));
  }
  return results;
}

nlohmann::ordered_json summary(const Results& results) {
  nlohmann::ordered_json json;
  json["cases"] = results.situations.size();
  for (std::size_t m = 0; m < results.methods.size(); ++m)
    json["failures"][results.methods[m].id] = std::count_if(
        results.of[m].begin(), results.of[m].end(), [](const Judgement& j) { return isFailure(j.verdict); });
  return json;
}

}  // namespace fcl_stpbv::stability
