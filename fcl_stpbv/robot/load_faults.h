// Gathers all errors in a robot's files, so that one message reports them before any work is done.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv {

/// Each entry is a whole message that names the file, the element and what would work.
struct LoadFaults {
  std::vector<std::string> errors;    ///< the robot cannot be loaded with these
  std::vector<std::string> shapes;    ///< each costs one shape; the others are sound
  std::vector<std::string> warnings;  ///< nothing is lost by these

  /// Runs `read`; an Error it throws becomes an entry of `list`.
  template <class Read>
  static void gather(std::vector<std::string>& list, Read read) {
    try {
      read();
    } catch (const Error& error) {
      list.emplace_back(error.what());
    }
  }

  /// @throws Error listing the errors and, unless they are to be left out, the shapes; where there are any.
  void refuse(bool leaveOutShapes = false) const;
};

}  // namespace fcl_stpbv
