// Which file each input of mesh_to_stpbv goes to. Everything that can be refused
// is refused before anything is written.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "tools/conversion.h"

namespace fcl_stpbv::tools {

/// The command line asks for something that cannot be done; the message
/// names the argument and what would work.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Job {
  std::string input, output;
};

struct Plan {
  std::string folder;  ///< to be made if missing; empty where the output is named file by file
  std::vector<Job> jobs;
};

/// Whether a volume for `output` goes to standard output.
bool isStandardOutput(const std::string& output);

/// One input goes to the file `output`, or into it where that is a folder; several go into the folder
/// `output`, each under its own stem.
/// @throws UsageError for values out of range, names that clash, and files that exist unless `force` is set.
Plan plan(const std::vector<std::string>& inputs, const std::string& output, const ConversionOptions& options,
          bool force);

}  // namespace fcl_stpbv::tools
