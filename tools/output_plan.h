// Decides to which file each input of mesh_to_stpbv goes. Everything that can be refused is refused before
// anything is written. No tool replaces a file that it reads.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "tools/conversion.h"

namespace fcl_stpbv::tools {

/// The command line asks for something that cannot be done. The message names the argument and what would
/// work.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Job {
  std::string input, output;
};

struct Plan {
  std::string folder;  ///< created if missing; empty if every output is named
  std::vector<Job> jobs;
};

/// @throws UsageError if writing `target`, the argument of `option`, would replace one of `inputs`, however
/// the two are named: a link, another path to the folder, or "-" for a file behind standard input.
void requireNoInput(const std::string& option, const std::string& target,
                    const std::vector<std::string>& inputs);

/// @throws UsageError as requireNoInput() does, and if `target` is a folder or, unless `force` is set, an
/// existing file.
void checkTarget(const std::string& option, const std::string& target, const std::vector<std::string>& inputs,
                 bool force);

/// The file of a part: `link.stpbv` becomes link_0.stpbv, link_1.stpbv and so on.
std::string nameOfPart(const std::string& output, int part);

/// Whether a volume for `output` goes to standard output.
bool isStandardOutput(const std::string& output);

/// One input goes to the file `output`, or into it if it is a folder. Several inputs go into the folder
/// `output`, each under its own stem. The number of parts is known only after they are found, so no name of a
/// part may be an input's or the preview's.
/// @throws UsageError for values out of range, names that clash, and files that exist unless `force` is set.
Plan plan(const std::vector<std::string>& inputs, const std::string& output, const ConversionOptions& options,
          bool force);

}  // namespace fcl_stpbv::tools
