// Data as text that a page can contain.
#pragma once

#include <cstddef>
#include <string>

namespace fcl_stpbv::report {

std::string base64(const void* data, std::size_t size);

/// The text compressed as a gzip file, in base64, for a browser's DecompressionStream. The same text gives
/// the same bytes.
std::string packed(const std::string& text);

}  // namespace fcl_stpbv::report
