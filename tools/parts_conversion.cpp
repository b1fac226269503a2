// See parts_conversion.h.
#include "tools/parts_conversion.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <sstream>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/error_place.h"
#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/mesh/mesh_write.h"
#include "fcl_stpbv/text_cells.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/tessellate.h"
#include "tools/output_plan.h"

namespace fcl_stpbv::tools {
namespace {

std::string millimetres(double metres) { return detail::formatted("%.3f mm", 1e3 * metres); }

double largest(const PartsReport& report, MeshExcess ConvexPart::*excess) {
  double most = 0;
  for (std::size_t k = 0; k < report.volumes.size(); ++k)
    most = std::max(most, (report.parts.parts[k].*excess).upper + report.overCovers[k].max);
  return most;
}

}  // namespace

double PartsReport::excessMax() const { return largest(*this, &ConvexPart::excess); }
double PartsReport::openExcessMax() const { return largest(*this, &ConvexPart::openExcess); }

PartsReport convertToParts(const std::string& input, const std::string& output,
                           const ConversionOptions& options, bool force) {
  PartsReport report;
  report.input = input;
  report.asked = options.parts->excess;
  const Content content = readInput(input, options.scale);
  if (content.volume)
    throw Error(input + ": is an STP-BV already, and convex; give the mesh it was made from, or leave out " +
                "--parts and --excess");
  if (content.mesh.triangles.empty())
    throw Error(input + ": has no triangles, which parts are made of; give a mesh");
  const auto start = std::chrono::steady_clock::now();
  detail::within(input, [&] {
    const StpBvOptions radii = radiiFor(content.mesh.vertices, options);  // for the whole mesh, as for a link
    report.parts = convexParts(content.mesh, *options.parts);
    for (const ConvexPart& part : report.parts.parts) {
      report.volumes.push_back(StpBv::build(part.points, radii));
      report.overCovers.push_back(overCover(*report.volumes.back(), part.points));
      if (!options.verify) continue;
      const Verification verification = verify(*report.volumes.back(), part.points);
      report.verified = report.verified && verification.ok;
      if (!verification.ok) report.verification = verification.message;
    }
  });
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (std::size_t k = 0; k < report.volumes.size(); ++k) {
    report.outputs.push_back(nameOfPart(output, static_cast<int>(k)));
    checkTarget("-o", report.outputs.back(), {}, force);  // not an input, because plan() has checked that
  }
  return report;
}

// Makes all texts first, because a format may not be able to represent one of the volumes.
void write(const PartsReport& report, const ConversionOptions& options) {
  std::vector<detail::NamedText> files;
  std::vector<TriangleMesh> surfaces;
  for (std::size_t k = 0; k < report.volumes.size(); ++k) {
    const std::string& name = report.outputs[k];
    files.push_back({name, fileText(*report.volumes[k], options.format, name)});
    if (!options.preview.empty()) surfaces.push_back(tessellate(*report.volumes[k]));
  }
  if (!options.preview.empty())
    files.push_back({options.preview, detail::colouredText(options.preview, surfaces)});
  detail::atomicWriteAll(files);
}

std::string toText(const PartsReport& report) {
  const ConvexParts& parts = report.parts;
  const std::size_t count = parts.parts.size();
  std::string text =
      detail::printable(report.input + " -> " + report.outputs.front()) + (count > 1 ? " ..." : "") + "\n  " +
      detail::counted(count, "part") + "; " + std::to_string(parts.closedPieces) + " of " +
      detail::counted(static_cast<std::size_t>(parts.pieces), "piece") + " closed, " +
      (parts.closedPieces > 0 ? "their inside is covered" : "the triangles alone are covered") +
      "\n  hulls within " + millimetres(parts.excess) + " of the mesh's solid, " +
      millimetres(parts.openExcess) + " of its triangles\n  volumes within " +
      millimetres(report.excessMax()) + detail::formatted("; %.2f s", report.seconds);
  if (!report.isReached())
    text += "\n  NOT within the " + millimetres(report.asked) + " asked for: more --parts or --effort may be";
  return text;
}

std::string toJson(const PartsReport& report) {
  nlohmann::ordered_json json;
  json["input"] = report.input;
  json["hull_excess_max"] = report.parts.excess;
  if (report.asked > 0) json["excess_reached"] = report.isReached();
  json["excess_max"] = report.excessMax();
  json["excess_max_open"] = report.openExcessMax();
  json["pieces"] = report.parts.pieces;
  json["closed_pieces"] = report.parts.closedPieces;
  json["seconds"] = report.seconds;
  for (std::size_t k = 0; k < report.volumes.size(); ++k) {
    nlohmann::ordered_json part;
    part["output"] = report.outputs[k];
    part["vertices"] = report.volumes[k]->vertexCount();
    part["hull_excess_max"] = report.parts.parts[k].excess.upper;
    part["over_cover_max"] = report.overCovers[k].max;
    json["parts"].push_back(part);
  }
  // A file's name may contain bytes that are not UTF-8.
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace fcl_stpbv::tools
