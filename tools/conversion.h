// One input to one STP-BV: what mesh_to_stpbv does with each of its inputs.
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
  std::string preview;                ///< mesh to write for a look, none if empty
  std::optional<PartsOptions> parts;  ///< several volumes for one mesh
  bool verify = false;
  bool measure = true;  ///< compute over-cover and volume for the report
};

/// What is reported of one input. Lengths in m.
struct Report {
  std::string input, output;
  std::size_t points = 0;  ///< read from the input
  StpBv::Ptr volume;
  std::optional<RadiiAdvice> advice;  ///< where it was asked for
  bool fitted = false;                ///< r or R fits the input's size
  OverCover overCover{};
  double cubicMetres = 0;
  /// Most that the volume exceeds the mesh by: what it encloses, or its triangles
  /// alone (m); none for what has no triangles.
  std::optional<double> excessMax, openExcessMax;
  double buildSeconds = 0;       ///< 0 for what is a volume already
  std::optional<bool> verified;  ///< set where it was asked for
  std::string verification;      ///< what is wrong with a volume that is not verified
};

/// What an input holds: a volume, or else points, of a mesh with its triangles.
struct Content {
  StpBv::Ptr volume;
  TriangleMesh mesh;
};

/// Reads a mesh, a cloud of points or a volume, told by its content; `scale` does not count for a volume.
/// @throws Error naming the input and what would work.
Content readInput(const std::string& path, double scale);

/// The r and R that the options say for these points, but for what `advise` leads to.
StpBvOptions radiiFor(const std::vector<Eigen::Vector3d>& points, const ConversionOptions& options);

/// The same, made into an STP-BV. Writes nothing.
/// @throws Error naming the input and what would work.
Report convert(const std::string& input, const ConversionOptions& options);

/// Writes what convert() made: the volume and, if asked for, its preview.
void write(const Report& report, const ConversionOptions& options);

/// Some lines for people to read.
std::string toText(const Report& report);

/// A line of JSON for programs to read.
std::string toJson(const Report& report);

}  // namespace fcl_stpbv::tools
