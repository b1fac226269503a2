// Writes a folder of files atomically: completely or not at all.
#pragma once

#include <map>
#include <string>

namespace fcl_stpbv::detail {

/// The contents of files by name. A name may contain folders, as in "meshes/arm.obj".
using FolderFiles = std::map<std::string, std::string>;

/// Makes `folder` hold exactly these files. They are written into a new folder beside it, which is then
/// renamed. The old folder is removed, so the caller must make sure that nothing is lost. The parent folder
/// must exist. Signals that would end the process are delayed meanwhile.
/// @throws Error naming the folder and the reason; the old folder is then unchanged.
void atomicWriteFolder(const std::string& folder, const FolderFiles& files);

/// Tests whether the folder can be created; call it before long work whose result is written there.
/// @throws Error as atomicWriteFolder() does.
void requireFolderPlace(const std::string& folder);

}  // namespace fcl_stpbv::detail
