// Converts one mesh to several STP-BVs that together cover it: mesh_to_stpbv with --parts or --excess.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/parts/convex_parts.h"
#include "tools/conversion.h"

namespace fcl_stpbv::tools {

/// The report about one input. Lengths in m.
struct PartsReport {
  std::string input;
  std::vector<std::string> outputs;  ///< one for each part
  ConvexParts parts;
  std::vector<StpBv::Ptr> volumes;
  std::vector<OverCover> overCovers;  ///< of each volume over its part
  double asked = 0;                   ///< the requested bound on the hulls' excess; 0 for none
  double seconds = 0;                 ///< time for the parts and their volumes
  bool verified = true;               ///< whether each volume contains its part; checked if requested
  std::string verification;

  /// Whether the hulls are as close to the mesh as requested.
  bool isReached() const { return asked == 0 || parts.excess <= asked; }
  /// Upper bound on the distance of the volumes' surfaces from the mesh's solid, or from its triangles alone.
  double excessMax() const;
  double openExcessMax() const;
};

/// Reads a mesh and makes the volumes of its parts. `output` is the name that a single volume would have
/// (nameOfPart()). Writes nothing.
/// @throws Error naming the input, UsageError naming an output (checkTarget()), and what would work.
PartsReport convertToParts(const std::string& input, const std::string& output,
                           const ConversionOptions& options, bool force);

/// Writes the volumes and, if requested, their preview, each in its own colour. If the format cannot
/// represent one of the volumes, or one cannot be written, no volume is written.
void write(const PartsReport& report, const ConversionOptions& options);

std::string toText(const PartsReport& report);
std::string toJson(const PartsReport& report);

}  // namespace fcl_stpbv::tools
