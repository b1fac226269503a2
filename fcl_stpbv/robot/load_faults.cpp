// Gathers what is wrong with a robot's files and throws it as one Error.
#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv {
namespace {

// A file that is wrong everywhere says so without filling the screen.
constexpr std::size_t kMostShown = 100;

}  // namespace

void LoadFaults::refuse(bool leaveOutShapes) const {
  std::vector<std::string> all = errors;
  if (!leaveOutShapes) all.insert(all.end(), shapes.begin(), shapes.end());
  if (all.empty()) return;
  if (all.size() == 1) throw Error(all[0]);
  std::string message = std::to_string(all.size()) + " things are wrong:";
  for (std::size_t i = 0; i < all.size() && i < kMostShown; ++i) message += "\n- " + all[i];
  if (all.size() > kMostShown) message += "\n- ... and " + std::to_string(all.size() - kMostShown) + " more";
  throw Error(message);
}

}  // namespace fcl_stpbv
