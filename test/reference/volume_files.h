// Shared by the tests of file formats: volumes of every kind, and texts with all kinds of damage.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::test {

struct NamedVolume {
  std::string name;
  StpBv::Ptr volume;
};

/// Volumes with one point to thousands, flat or round, with and without k-gon faces.
std::vector<NamedVolume> volumesOfEveryKind();

/// The volumes that have a face and no edge of more than half a turn.
std::vector<NamedVolume> volumesForSch();

/// Calls `load` with the text. @returns the message of the Error that it throws, or "" if it throws none.
template <class Load>
std::string refusal(Load load, const std::string& text) {
  try {
    load(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// The folder of sample files beside the project, "" if it is missing.
std::string sharedFolder(const std::string& name);

/// A new empty folder that is removed at the end with its contents.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  std::vector<std::string> files() const;

 private:
  std::string path_;
};

std::string contentOf(const std::string& path);
void put(const std::string& path, const std::string& content);

}  // namespace fcl_stpbv::test
