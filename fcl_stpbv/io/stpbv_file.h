// The library's own `.stpbv` format: a short text that holds vertices, faces and
// radii exactly (docs/file_formats.md).
#pragma once

#include <iosfwd>
#include <string>
#include <string_view>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// Writes the volume. The same volume gives the same bytes, and reading them back gives the same volume bit
/// by bit. A failed or interrupted write leaves an old file as it was.
/// @throws Error naming the file when it cannot be written.
void saveStpBv(const std::string& path, const StpBv& volume);
/// The same to a stream.
void saveStpBv(std::ostream& out, const StpBv& volume);

/// Reads a volume; its patches are rebuilt from the vertices and faces.
/// @throws Error "file:line: got ..., expected ..." for a file that is damaged or no STP-BV.
StpBv::Ptr loadStpBv(const std::string& path);
/// The same from a stream; `name` stands for it in messages.
StpBv::Ptr loadStpBv(std::istream& in, const std::string& name = "stream");

/// Whether a file that begins like this claims to be in this format.
bool looksLikeStpBv(std::string_view text);

}  // namespace fcl_stpbv
