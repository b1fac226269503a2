// Compares each link's volume with one built from a published polyhedron: how far the surfaces are apart, and
// which vertices have no partner.
#include "fcl_stpbv/report/published_polyhedra.h"

#include <algorithm>
#include <filesystem>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "fcl_stpbv/volume/measure.h"

namespace fcl_stpbv::report {

std::vector<PolyhedronReport> comparePolyhedra(const RobotGeometry& geometry, const std::string& folder) {
  namespace fs = std::filesystem;
  constexpr double kSame = 1e-6;  // m; usually the last digit with which mesh files are written
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) throw Error("--polyhedra " + folder + ": is no folder");
  std::vector<PolyhedronReport> reports;
  for (const Body& body : geometry.bodies) {
    PolyhedronReport report;
    const std::string stem = fs::path(body.file).stem().string();
    for (const char* ending : {"-ch.txt", ".otp"}) {
      const fs::path file = fs::path(folder) / (stem + ending);
      if (body.volume && body.partOf < 0 && report.file.empty() && fs::is_regular_file(file, ignored))
        report.file = file.string();
    }
    if (!report.file.empty()) {
      const StpBv& mesh = body.isReduced() ? body.full->volume() : *body.volume;
      const StpBv::Ptr polyhedron = StpBv::build(loadPoints(report.file), {mesh.radii().r, mesh.radii().R});
      report.meshVertices = mesh.vertexCount();
      report.vertices = polyhedron->vertexCount();
      report.meshAlone = withoutPartner(mesh, *polyhedron, kSame);
      report.alone = withoutPartner(*polyhedron, mesh, kSame);
      report.difference = surfaceDifference(mesh, *polyhedron);
    }
    reports.push_back(std::move(report));
  }
  if (std::all_of(reports.begin(), reports.end(), [](const PolyhedronReport& r) { return r.file.empty(); }))
    throw Error("--polyhedra " + folder + ": holds a MESH-ch.txt or MESH.otp for no mesh of the robot");
  return reports;
}

}  // namespace fcl_stpbv::report
