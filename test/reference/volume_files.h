// What the tests of file formats share: volumes of every kind, and texts damaged in every way.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::test {

struct NamedVolume {
  std::string name;
  StpBv::Ptr volume;
};

/// From one point to thousands, flat, round, with k-gon faces and without.
std::vector<NamedVolume> volumesOfEveryKind();

/// Those with a face and no edge of more than half a turn.
std::vector<NamedVolume> volumesForSch();

/// Calls `load` with the text; gives the message of the Error it throws, or "" if it throws none.
template <class Load>
std::string refusal(Load load, const std::string& text) {
  try {
    load(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// The folder of sample files beside the project, "" where it is missing.
std::string sharedFolder(const std::string& name);

/// A new empty folder that is removed with all it holds.
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
