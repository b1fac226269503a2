// Texts of a report without the folders of files: a page is passed on, and says nothing of its maker's disk.
#pragma once

#include <string>

namespace fcl_stpbv::report {

/// `text` in which each absolute path, and `file` as it was given, is the file's name alone. A path begins at
/// the text's start or behind a space, a quote or a bracket.
std::string withoutFolders(std::string text, const std::string& file);

}  // namespace fcl_stpbv::report
