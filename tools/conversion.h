// Converts one input to one STP-BV: what mesh_to_stpbv does with each of its inputs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fcl_stpbv/parts/convex_parts.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/radii_advice.h"
#include "fcl_stpbv/volume/stp_bv.h"
#include "tools/asked_radii.h"

namespace fcl_stpbv::tools {

enum class Format { stpbv, sch };

struct ConversionOptions {
  AskedRadii radii;
  std::optional<RadiiTask> advise;  ///< the radii that it leads to, instead
  double scale = 1;
  Format format = Format::stpbv;
  std::string preview;                ///< file for a mesh of the volume's surface; "" for none
  std::optional<PartsOptions> parts;  ///< set if one mesh becomes several volumes
  bool verify = false;
  bool measure = true;  ///< compute over-cover and volume for the report
};

/// The report about one input. Lengths in m.
struct Report {
  std::string input, output;
  std::size_t points = 0;  ///< number of points read from the input
  StpBv::Ptr volume;
  std::optional<RadiiAdvice> advice;  ///< set if it was requested
  bool fitted = false;                ///< whether r or R was fitted to the input's size
  OverCover overCover{};
  double cubicMetres = 0;
  /// Upper bounds on how far the volume exceeds the mesh: the solid that the mesh encloses, or its triangles
  /// alone (m). No value if the input has no triangles.
  std::optional<double> excessMax, openExcessMax;
  double buildSeconds = 0;       ///< 0 if the input is a volume already
  std::optional<bool> verified;  ///< set if it was requested
  std::string verification;      ///< what is wrong with a volume that failed the check
};

/// The contents of an input: a volume, or points, with triangles if it is a mesh.
struct Content {
  StpBv::Ptr volume;
  TriangleMesh mesh;
};

/// Reads a mesh, a cloud of points or a volume, recognised by its content. `scale` is ignored for a volume.
/// @throws Error naming the input and what would work.
Content readInput(const std::string& path, double scale);

/// The r and R that the options give for these points, without the effect of `advise`.
StpBvOptions radiiFor(const std::vector<Eigen::Vector3d>& points, const ConversionOptions& options);

/// Reads an input and makes it an STP-BV. Writes nothing.
/// @throws Error naming the input and what would work.
Report convert(const std::string& input, const ConversionOptions& options);

/// Writes the result of convert(): the volume and, if requested, its preview.
void write(const Report& report, const ConversionOptions& options);

/// A volume as the text of the file `name`. @throws Error naming it, if the format cannot represent the
/// volume.
std::string fileText(const StpBv& volume, Format format, const std::string& name);

/// Some lines for people to read.
std::string toText(const Report& report);

/// A line of JSON for programs to read.
std::string toJson(const Report& report);

}  // namespace fcl_stpbv::tools
