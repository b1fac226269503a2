// Reads and writes volume files and reads point files (docs/file_formats.md). There are three formats: the
// library's own `.stpbv`, a short text that stores vertices, faces and radii exactly; sch-core's; and
// qhull's.
#pragma once

#include <Eigen/Core>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// Writes the volume as `.stpbv`. The same volume gives the same bytes, and reading them back gives the same
/// volume bit by bit. If the write fails or is interrupted, an existing file stays unchanged.
/// @throws Error naming the file if it cannot be written.
void saveStpBv(const std::string& path, const StpBv& volume);
/// saveStpBv() to a stream. @throws Error if the stream cannot be written.
void saveStpBv(std::ostream& out, const StpBv& volume);

/// Reads a `.stpbv`; the patches are rebuilt from the vertices and faces.
/// @throws Error "file:line: got ..., expected ..." for a file that is damaged or no STP-BV.
StpBv::Ptr loadStpBv(const std::string& path);
/// loadStpBv() from a stream; `name` stands for the file in messages. @throws Error as above.
StpBv::Ptr loadStpBv(std::istream& in, const std::string& name = "stream");

/// Whether a file that begins with this text claims to be `.stpbv`.
bool looksLikeStpBv(std::string_view text);

/// Reads the points (as in the file, usually m) of a qhull file. Two forms are known: the output of `o f`
/// (dimension, `points facets ridges`, points, facets) and qhull's input (dimension, number of points,
/// points). Facets are checked but not returned, since a volume is built from points. The text after the
/// facets is qhull's report and is not read.
/// @throws Error "file:line: got ..., expected ..." for a damaged file or another dimension than 3.
std::vector<Eigen::Vector3d> loadQhullPoints(const std::string& path);

/// loadQhullPoints() from a text in memory; `name` stands for it in messages.
std::vector<Eigen::Vector3d> parseQhullPoints(std::string_view text, const std::string& name);

/// Whether a text begins like a qhull file: a line with the dimension, then a line with one or three counts.
bool looksLikeQhull(std::string_view text);

/// Writes the volume so that sch-core can load it. A k-gon face becomes a fan of triangles whose inner edges
/// are marked degenerate. The same volume gives the same bytes; numbers read back exactly.
/// @throws Error naming the file when it cannot be written; also for a volume that the format cannot store:
/// one or two vertices (no face), or an edge whose normals turn by more than half a turn.
void saveSch(const std::string& path, const StpBv& volume);
/// saveSch() to a stream. @throws Error as above.
void saveSch(std::ostream& out, const StpBv& volume);

/// Reads a volume in sch-core's format. The file states some facts twice. They are compared to within the
/// printed digits (old files have six), and a contradiction is an error. If the file has all digits of a
/// double, its faces are kept. If it has fewer, so that vertices no longer lie on their balls, the volume is
/// built anew from the vertices.
/// @throws Error "file:line: what is wrong, what was expected".
StpBv::Ptr loadSch(const std::string& path);
/// loadSch() from a stream; `name` stands for the file in messages. @throws Error as above.
StpBv::Ptr loadSch(std::istream& in, const std::string& name = "stream");

/// Whether a text begins like a file of sch-core: the two radii, then a line with nothing but a count.
bool looksLikeSch(std::string_view text);

}  // namespace fcl_stpbv
