// Collects all faults of a robot's files and throws them as one Error.
#include <set>
#include <string>
#include <string_view>

#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv {
namespace {

// Largest number of faults in a message, so that it does not fill the screen.
constexpr std::size_t kMostShown = 100;
constexpr std::string_view kHint = "\nGive ";

// Where the last line begins if it is a hint, such as the hint for a missing package; else the end of the
// message.
std::size_t hintOf(const std::string& message) {
  const std::size_t line = message.rfind("\n");
  return line != std::string::npos && message.compare(line, kHint.size(), kHint) == 0 ? line : message.size();
}

}  // namespace

void LoadFaults::refuse(bool leaveOutShapes) const {
  std::vector<std::string> all = errors;
  if (!leaveOutShapes) all.insert(all.end(), shapes.begin(), shapes.end());
  if (all.empty()) return;
  if (all.size() == 1) throw Error(all[0]);
  std::string message = std::to_string(all.size()) + " things are wrong:";
  std::set<std::string> hints;  // each hint is given once, where it first helps
  for (std::size_t i = 0; i < all.size() && i < kMostShown; ++i) {
    const std::size_t hint = hintOf(all[i]);
    message += "\n- " + all[i].substr(0, hint);
    if (hints.insert(all[i].substr(hint)).second) message += all[i].substr(hint);
  }
  if (all.size() > kMostShown) message += "\n- ... and " + std::to_string(all.size() - kMostShown) + " more";
  throw Error(message);
}

}  // namespace fcl_stpbv
