// Which file each input of mesh_to_stpbv goes to. Everything that can be refused
// is refused before anything is written. No tool replaces a file that it reads.
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

/// @throws UsageError where writing `target`, the argument of `option`, would replace one of `inputs`,
/// however the two are named: a link, another way to the folder, or "-" for a file behind standard input.
void requireNoInput(const std::string& option, const std::string& target,
                    const std::vector<std::string>& inputs);

/// @throws UsageError as above, and where `target` is a folder or, unless `force` is set, a file that exists.
void checkTarget(const std::string& option, const std::string& target, const std::vector<std::string>& inputs,
                 bool force);

/// `link.stpbv` names link_0.stpbv, link_1.stpbv and so on.
std::string nameOfPart(const std::string& output, int part);

/// Whether a volume for `output` goes to standard output.
bool isStandardOutput(const std::string& output);

/// One input goes to the file `output`, or into it where that is a folder; several go into the folder
/// `output`, each under its own stem.
/// Of parts, whose number is known only when they are found, no name may be an input's or the preview's.
/// @throws UsageError for values out of range, names that clash, and files that exist unless `force` is set.
Plan plan(const std::vector<std::string>& inputs, const std::string& output, const ConversionOptions& options,
          bool force);

}  // namespace fcl_stpbv::tools
