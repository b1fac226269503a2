// Names of temporary files and folders beside what they become, and the message where one cannot be written.
#pragma once

#include <string>
#include <string_view>

namespace fcl_stpbv::detail {

/// @throws Error naming the path, and the reason: a value of errno.
[[noreturn]] void refuseWrite(const std::string& path, int error);

/// The folder that `path` is in.
std::string folderOf(const std::string& path);

/// A path beside `path` that nothing in this process had before. Another process may have left it there.
std::string temporaryBeside(const std::string& path);

/// Whether a name, without its folder, is one of those.
bool isTemporary(std::string_view name);

}  // namespace fcl_stpbv::detail
