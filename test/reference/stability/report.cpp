// The suite's results case by case, for the tables and the picture that are made from them.
#include "test/reference/stability/suite.h"

namespace fcl_stpbv::stability {

std::vector<nlohmann::ordered_json> caseRows(const Results& results) {
  std::vector<nlohmann::ordered_json> rows;
  for (std::size_t i = 0; i < results.situations.size(); ++i) {
    const Situation& situation = results.situations[i];
    nlohmann::ordered_json verdicts, amounts;
    for (const auto& judged : results.of) {
      verdicts.push_back(nameOf(judged[i].verdict));
      amounts.push_back(judged[i].amount);
    }
    rows.push_back({{"group", situation.group},
                    {"case", situation.name},
                    {"placements", situation.placements.size()},
                    {"verdicts", std::move(verdicts)},
                    {"amounts", std::move(amounts)}});
  }
  return rows;
}

nlohmann::ordered_json methodNames(const Results& results) {
  nlohmann::ordered_json names;
  for (const Method& method : results.methods) names.push_back({{"id", method.id}, {"title", method.title}});
  return names;
}

}  // namespace fcl_stpbv::stability
