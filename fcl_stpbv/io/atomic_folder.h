// Writes a folder of files whole or not at all.
#pragma once

#include <map>
#include <string>

namespace fcl_stpbv::detail {

/// Contents by name; a name may have folders, as in "meshes/arm.obj".
using FolderFiles = std::map<std::string, std::string>;

/// Makes `folder` hold exactly these files. They are written into a new folder beside it, which then takes
/// its name; what was there before is removed after that, so whoever calls makes sure that nothing is lost.
/// Its parent must be there. Signals that would end the process wait meanwhile.
/// @throws Error naming the folder and the reason; the old one is as it was then.
void atomicWriteFolder(const std::string& folder, const FolderFiles& files);

/// Tries whether a folder can be made there, for who will write it after long work.
/// @throws Error as atomicWriteFolder() does.
void requireFolderPlace(const std::string& folder);

}  // namespace fcl_stpbv::detail
