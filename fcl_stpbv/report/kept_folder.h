// Checks whether the output folder of an earlier conversion may be replaced.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "fcl_stpbv/io/atomic_write.h"

namespace fcl_stpbv::report {

inline constexpr const char* kManifest = "manifest.json";

/// Checks a folder before the work starts. A folder with files that a conversion did not write, or that were
/// changed since, is an error, so that no file of the user is lost.
/// @param inputs files that the conversion reads, none of which may lie in the folder
/// @param force files that a conversion wrote may have been changed since
/// @return the key in the folder's manifest, "" unless all files of the folder are as they were written.
/// @throws Error naming the folder or file, and what would work.
std::string keyOfFolder(const std::string& folder, const std::vector<std::string>& inputs, bool force);

/// The warnings in the manifest of a folder that keyOfFolder() has accepted.
std::vector<std::string> warningsOfFolder(const std::string& folder);

/// The manifest's own entries: the key and each file's SHA-256.
void addFiles(nlohmann::ordered_json& manifest, const std::string& key, const detail::FolderFiles& files);

}  // namespace fcl_stpbv::report
