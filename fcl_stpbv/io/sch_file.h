// sch-core's text format for STP-BVs, as its loader takes it and
// sch-creator writes it (docs/file_formats.md).
#pragma once

#include <iosfwd>
#include <string>
#include <string_view>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// Writes the volume so that sch-core can load it. A k-gon face becomes a fan of triangles whose inner edges
/// are marked degenerate. The same volume gives the same bytes; numbers read back exactly.
/// @throws Error naming the file when it cannot be written, or saying what of this volume the format cannot
/// hold: one or two vertices (no face), or an edge that turns by more than half a turn.
void saveSch(const std::string& path, const StpBv& volume);
/// The same to a stream.
void saveSch(std::ostream& out, const StpBv& volume);

/// Reads a volume. Everything the file says twice is compared within the digits it carries (old
/// files have six), and a file that disagrees with itself is refused. A file with a double's full
/// digits gives back its own faces; from one with fewer, where vertices no longer lie on their
/// balls, the volume is built anew from the vertices.
/// @throws Error "file:line: what is wrong, what was expected".
StpBv::Ptr loadSch(const std::string& path);
/// The same from a stream; `name` stands for it in messages.
StpBv::Ptr loadSch(std::istream& in, const std::string& name = "stream");

/// Whether a text begins like such a file: a line with the two radii, then a count.
bool looksLikeSch(std::string_view text);

}  // namespace fcl_stpbv
