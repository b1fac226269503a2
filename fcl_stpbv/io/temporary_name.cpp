// Temporary files are named by process and number, whatever they become: no name gets too long.
#include "fcl_stpbv/io/temporary_name.h"

#include <unistd.h>

#include <atomic>
#include <cstring>
#include <filesystem>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv::detail {
namespace {

constexpr std::string_view kBegin = ".fcl_stpbv-", kEnd = ".tmp";

}  // namespace

void refuseWrite(const std::string& path, int error) {
  throw Error(path + ": cannot be written: " + std::strerror(error));
}

std::string folderOf(const std::string& path) {
  const std::string parent = std::filesystem::path(path).parent_path().string();
  return parent.empty() ? "." : parent;
}

std::string temporaryBeside(const std::string& path) {
  static std::atomic<unsigned> serial{0};
  return folderOf(path) + "/" + std::string(kBegin) + std::to_string(::getpid()) + "-" +
         std::to_string(serial++) + std::string(kEnd);
}

bool isTemporary(std::string_view name) {
  return name.size() > kBegin.size() + kEnd.size() && name.substr(0, kBegin.size()) == kBegin &&
         name.substr(name.size() - kEnd.size()) == kEnd;
}

}  // namespace fcl_stpbv::detail
