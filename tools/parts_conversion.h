// One mesh to several STP-BVs that together cover it: mesh_to_stpbv with --parts or --excess.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/parts/convex_parts.h"
#include "tools/conversion.h"

namespace fcl_stpbv::tools {

/// What is reported of one input. Lengths in m.
struct PartsReport {
  std::string input;
  std::vector<std::string> outputs;  ///< one a part
  ConvexParts parts;
  std::vector<StpBv::Ptr> volumes;
  std::vector<OverCover> overCovers;  ///< of each volume over its part
  double asked = 0;                   ///< excess that the hulls were to keep; 0 for none
  double seconds = 0;                 ///< for the parts and their volumes
  bool verified = true;               ///< each volume holds its part; where it was asked for
  std::string verification;

  /// Whether the hulls are as near as asked for.
  bool isReached() const { return asked == 0 || parts.excess <= asked; }
  /// Most that a point of the volumes' surfaces is from the mesh's solid, or from its triangles alone.
  double excessMax() const;
  double openExcessMax() const;
};

/// Reads a mesh and makes the volumes of its parts. `output` is the name that would be a single volume's
/// (nameOfPart()). Writes nothing.
/// @throws Error naming the input, UsageError naming an output (checkTarget()), and what would work.
PartsReport convertToParts(const std::string& input, const std::string& output,
                           const ConversionOptions& options, bool force);

/// Writes the volumes, and if asked for their preview, each in a colour. No volume is written where the
/// format cannot hold one of them, or one cannot be written.
void write(const PartsReport& report, const ConversionOptions& options);

std::string toText(const PartsReport& report);
std::string toJson(const PartsReport& report);

}  // namespace fcl_stpbv::tools
