// See radii_task.h.
#include "tools/radii_task.h"

#include <map>
#include <set>

#include "tools/number_check.h"
#include "tools/output_plan.h"

namespace fcl_stpbv::tools {
namespace {

constexpr double kLeast = 1e-9;  // m, m/s^2: the limit of adviseRadii()

}  // namespace

RadiiTask radiiTask(const std::string& text) {
  RadiiTask task;
  const std::map<std::string, double*> numbers{
      {"clearance", &task.clearance}, {"acceleration", &task.acceleration},
      {"speed", &task.speed},         {"turning", &task.turning},
      {"period", &task.period},       {"distance", &task.distance}};
  std::set<std::string> said;
  for (const std::string& word : splitAtCommas(text)) {
    const std::size_t equals = word.find('=');
    const std::string key = word.substr(0, equals),
                      value = equals == std::string::npos ? "" : word.substr(equals + 1);
    if (!said.insert(key).second)
      throw UsageError("--advise " + text + ": " + key + " comes twice; give it once");
    const auto number = numbers.find(key);
    if (key == "others" && (value == "round" || value == "flat")) {
      task.bothRound = value == "round";
      continue;
    }
    if (number == numbers.end())
      throw UsageError("--advise " + text + ": got '" + word +
                       "', expected clearance=, acceleration=, speed=, turning=, period= or distance= with a "
                       "number, or others=round or flat, with commas between");
    const double least = key == "clearance" || key == "acceleration" ? kLeast : 0;
    const std::string wrong = wrongNumber(value, least, kLargest);
    if (!wrong.empty()) throw UsageError("--advise " + text + ": " + key + ": " + wrong);
    *number->second = numberIn(value);
  }
  return task;
}

}  // namespace fcl_stpbv::tools
