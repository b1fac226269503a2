// Files of volumes and of points (docs/file_formats.md): the library's own `.stpbv`, a short text that holds
// vertices, faces and radii exactly; sch-core's; and qhull's.
#pragma once

#include <Eigen/Core>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// Writes the volume as `.stpbv`. The same volume gives the same bytes, and reading them back gives the same
/// volume bit by bit. A failed or interrupted write leaves an old file as it was.
/// @throws Error naming the file when it cannot be written.
void saveStpBv(const std::string& path, const StpBv& volume);
/// The same to a stream. @throws Error when it cannot be written to.
void saveStpBv(std::ostream& out, const StpBv& volume);

/// Reads a `.stpbv`; the patches are rebuilt from the vertices and faces.
/// @throws Error "file:line: got ..., expected ..." for a file that is damaged or no STP-BV.
StpBv::Ptr loadStpBv(const std::string& path);
/// The same from a stream; `name` stands for the file in messages. @throws Error as above.
StpBv::Ptr loadStpBv(std::istream& in, const std::string& name = "stream");

/// Whether a file that begins like this claims to be `.stpbv`.
bool looksLikeStpBv(std::string_view text);

/// Reads the points of a file that qhull printed with `o f` (dimension, `points facets ridges`, points,
/// facets) or that it takes as input (dimension, number of points, points). Facets are checked, then left
/// aside: the volume is built from the points. What follows the facets is qhull's report and is not read.
/// @throws Error "file:line: got ..., expected ..." for a damaged file or another dimension than 3.
std::vector<Eigen::Vector3d> loadQhullPoints(const std::string& path);

/// The same from a text in memory; `name` stands for it in messages.
std::vector<Eigen::Vector3d> parseQhullPoints(std::string_view text, const std::string& name);

/// Whether a text begins like such a file: a line with the dimension, a line with one or three counts.
bool looksLikeQhull(std::string_view text);

/// Writes the volume so that sch-core can load it. A k-gon face becomes a fan of triangles whose inner edges
/// are marked degenerate. The same volume gives the same bytes; numbers read back exactly.
/// @throws Error naming the file when it cannot be written, or saying what of this volume the format cannot
/// hold: one or two vertices (no face), or an edge that turns by more than half a turn.
void saveSch(const std::string& path, const StpBv& volume);
/// The same to a stream. @throws Error as above.
void saveSch(std::ostream& out, const StpBv& volume);

/// Reads a volume of sch-core's format. Everything the file says twice is compared within the digits it
/// carries (old files have six), and a file that disagrees with itself is refused. A file with a double's
/// full digits gives back its own faces; from one with fewer, where vertices no longer lie on their balls,
/// the volume is built anew from the vertices.
/// @throws Error "file:line: what is wrong, what was expected".
StpBv::Ptr loadSch(const std::string& path);
/// The same from a stream; `name` stands for the file in messages. @throws Error as above.
StpBv::Ptr loadSch(std::istream& in, const std::string& name = "stream");

/// Whether a text begins like sch-core's files: a line with the two radii, then a count.
bool looksLikeSch(std::string_view text);

}  // namespace fcl_stpbv
