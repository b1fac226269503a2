// See conversion.h.
#include "tools/conversion.h"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/error_place.h"
#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/mesh/file_ending.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "fcl_stpbv/mesh/mesh_write.h"
#include "fcl_stpbv/parts/mesh_solid.h"
#include "fcl_stpbv/robot/fitted_radii.h"
#include "fcl_stpbv/text_cells.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv::tools {
namespace {

using namespace detail;
using Points = std::vector<Eigen::Vector3d>;

// Decides by the file's first words.
bool holdsVolume(const std::string& path) {
  std::string head(256, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  return looksLikeStpBv(head) || looksLikeSch(head);
}

// A volume no longer has the points that its own radii left inside, so it cannot be converted to other radii.
void checkSameRadii(const std::string& input, const Radii& radii, const ConversionOptions& options) {
  if (options.advise)
    throw Error(input + ": is an STP-BV already; give the mesh it was made from, or leave out --advise");
  const AskedRadii& asked = options.radii;
  const bool same =
      !asked.fits() && asked.r.value_or(radii.r) == radii.r && asked.R.value_or(radii.R) == radii.R;
  if (same && options.scale == 1) return;
  throw Error(input + ": is an STP-BV already, made with r = " + toDecimal(radii.r) +
              " and R = " + toDecimal(radii.R) +
              "; leave out -r, -R and --scale to convert its format, or give the mesh it was made from");
}

// @throws Error if no radii keep both promises.
RadiiAdvice advised(const std::string& input, const Points& points, const RadiiTask& task) {
  const RadiiAdvice advice = detail::within(input, [&] { return adviseRadii(points, task); });
  if (advice.meetsBoth) return advice;
  throw Error(input + ": no r and R keep both promises. With acceleration=" + toDecimal(advice.acceleration) +
              " the clearance is enough, at r = " + toDecimal(advice.radii.r) +
              " and R = " + toDecimal(advice.radii.R) + "; " +
              (std::isfinite(advice.leastClearance)
                   ? "with clearance=" + toDecimal(advice.leastClearance) + " the acceleration is kept"
                   : "no volume of this body keeps the acceleration"));
}

std::string number(double value) { return detail::formatted("%.4g", value); }

void check(Report& report, const Points& points, const ConversionOptions& options) {
  if (options.verify) {
    const Verification verification = verify(*report.volume, points);
    report.verified = verification.ok;
    report.verification = verification.message;
  }
  if (options.measure) {
    report.overCover = overCover(*report.volume, points);
    report.cubicMetres = enclosedVolume(*report.volume);
  }
}

void measureExcess(Report& report, const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return;
  const MeshSolid solid(mesh);
  const auto excess = [&](bool filled) {
    return hullExcess(solid.pieces().vertices, solid, quickExcess(filled)).upper + report.overCover.max;
  };
  report.excessMax = excess(true);
  report.openExcessMax = excess(false);
}

}  // namespace

// A pipe is read once, because it cannot be read twice. A mesh in a file is left to the reader of meshes,
// which also knows the file's name and what is beside it.
Content readInput(const std::string& path, double factor) {
  const Eigen::Vector3d scale = Eigen::Vector3d::Constant(factor);
  const std::string extension = lowerExtension(path);
  if (extension == ".stpbv") return {loadStpBv(path), {}};
  std::error_code ignored;
  const bool isFile = path != "-" && std::filesystem::is_regular_file(path, ignored);
  if (isFile && extension != ".txt" && !extension.empty()) {
    try {
      return {nullptr, loadMesh(path, scale)};
    } catch (const Error&) {
      if (!holdsVolume(path)) throw;  // a volume may have a name of any form
    }
  }
  std::istringstream stream(readText(path));
  const std::string text = stream.str();
  if (looksLikeStpBv(text)) return {loadStpBv(stream, path), {}};
  if (!looksLikeQhull(text) && looksLikeSch(text)) return {loadSch(stream, path), {}};
  return {nullptr, isFile ? loadMesh(path, scale) : parseMesh(text, path, scale)};
}

StpBvOptions radiiFor(const Points& points, const ConversionOptions& options) {
  const AskedRadii& asked = options.radii;
  return withFitted(asked.lengths(), asked.fitSmallRadius, asked.fitBigRadius,
                    [&] { return sizeOf(points); });
}

Report convert(const std::string& input, const ConversionOptions& options) {
  Report report;
  report.input = input;
  Content content = readInput(input, options.scale);
  report.volume = content.volume;
  Points& points = content.mesh.vertices;
  if (report.volume) {
    checkSameRadii(input, report.volume->radii(), options);
    points = report.volume->vertices();
  } else {
    if (options.advise) report.advice = advised(input, points, *options.advise);
    report.fitted = options.radii.fits();
    const auto start = std::chrono::steady_clock::now();
    report.volume = detail::within(input, [&] {
      return StpBv::build(points, report.advice ? report.advice->radii : radiiFor(points, options));
    });
    report.buildSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  report.points = points.size();
  detail::within(input, [&] {
    check(report, points, options);
    if (options.measure) measureExcess(report, content.mesh);
  });
  return report;
}

void write(const Report& report, const ConversionOptions& options) {
  const bool isShown = !options.preview.empty();
  const TriangleMesh surface = isShown ? tessellate(*report.volume) : TriangleMesh();
  if (isShown && surface.triangles.empty())
    throw Error(report.input + ": one point with r = 0 has no surface; give -r, or leave out --preview");
  std::vector<NamedText> files{{report.output, fileText(*report.volume, options.format, report.output)}};
  if (isShown) files.push_back({options.preview, colouredText(options.preview, {surface})});
  atomicWriteAll(files);
}

std::string fileText(const StpBv& volume, Format format, const std::string& name) {
  std::ostringstream text;
  within(name, [&] { format == Format::sch ? saveSch(text, volume) : saveStpBv(text, volume); });
  return text.str();
}

std::string toText(const Report& report) {
  const StpBv& body = *report.volume;
  const auto millimetres = [](double metres) { return number(1e3 * metres) + " mm"; };
  std::string text = detail::printable(report.input + " -> " + report.output) + "\n  " +
                     std::to_string(report.points) + " points in, " + std::to_string(body.vertexCount()) +
                     " vertices, " + std::to_string(body.edgeCount()) + " edges, " +
                     std::to_string(body.faceCount()) + " faces; volume " + number(report.cubicMetres) +
                     " m^3\n  over-cover max " + millimetres(report.overCover.max) + ", mean " +
                     millimetres(report.overCover.mean);
  if (report.buildSeconds > 0) text += detail::formatted("; built in %.3f s", report.buildSeconds);
  if (report.verified == true) text += "; verified";
  if (report.fitted)
    text += "\n  fitted r " + millimetres(body.radii().r) + ", R " + number(body.radii().R) + " m";
  if (report.advice)
    text += "\n  advised r " + millimetres(body.radii().r) + ", R " + number(body.radii().R) +
            " m, at most " + number(report.advice->acceleration) + " m/s^2";
  return text;
}

std::string toJson(const Report& report) {
  const StpBv& body = *report.volume;
  nlohmann::ordered_json json;
  json["input"] = report.input;
  json["points"] = report.points;
  json["vertices"] = body.vertexCount();
  json["edges"] = body.edgeCount();
  json["faces"] = body.faceCount();
  json["r"] = body.radii().r;
  json["R"] = body.radii().R;
  if (report.advice) {
    json["advised_acceleration"] = report.advice->acceleration;
    json["advised_per_period"] = report.advice->perPeriod;
  }
  json["over_cover_max"] = report.overCover.max;
  json["over_cover_mean"] = report.overCover.mean;
  const auto orNull = [](const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
  };
  json["excess_max"] = orNull(report.excessMax);
  json["excess_max_open"] = orNull(report.openExcessMax);
  json["volume"] = report.cubicMetres;
  json["build_seconds"] = report.buildSeconds;
  json["verified"] =
      report.verified ? nlohmann::ordered_json(*report.verified) : nlohmann::ordered_json(nullptr);
  // A file's name may contain bytes that are not UTF-8.
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace fcl_stpbv::tools
