// How far a link's hull exceeds its mesh (parts/mesh_solid.h) and, with the over-cover, how far its volume
// does. A mesh's figures are kept with the volumes, found by the mesh's content and the volume.
#include "fcl_stpbv/report/mesh_fit.h"

#include <cmath>
#include <string>
#include <vector>

#include "fcl_stpbv/parts/mesh_solid.h"
#include "fcl_stpbv/robot/keyed_mesh.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

// The fit of a whole body.
MeshFit measured(const Body& body, const ExactBody& exact) {
  MeshFit fit;
  fit.closed = exact.closed();
  if (const MeshSolid* solid = exact.solid())
    fit.hullExcess = hullExcess(solid->pieces().vertices, *solid, quickExcess(false)).upper;
  if (body.volume)
    fit.volumeRatio =
        enclosedVolume(*body.volume) / (body.primitive ? body.primitive->computeVolume() : exact.volume());
  return fit;
}

// The fit as the cache stores it: as finite numbers, with 0 in place of a missing ratio.
std::vector<double> toNumbers(const MeshFit& fit) {
  return {fit.hullExcess, std::isfinite(fit.volumeRatio) ? fit.volumeRatio : 0.0, fit.closed ? 1.0 : 0.0};
}

// Appends the number of values before their bytes, so that no two contents give the same bytes.
template <class T>
void appendBytes(std::string& content, const std::vector<T>& values) {
  content += std::to_string(values.size()) + ' ';
  content.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

}  // namespace

std::string contentOf(const Body& body) {
  std::string content;
  appendBytes(content, body.hull);
  if (body.volume) {
    const StpBv& volume = *body.volume;
    appendBytes(content, std::vector<double>{volume.radii().r, volume.radii().R});
    appendBytes(content, volume.vertices());
    for (const StpBv::Ring& ring : volume.faces()) appendBytes(content, ring);
  }
  return content + meshKey(body);
}

MeshFit meshFit(const Body& body, const std::function<const ExactBody&()>& exact, VolumeCache& cache) {
  MeshFit fit;
  if (body.partOf >= 0) {
    fit.hullExcess = body.openExcess;
  } else if (body.file.empty()) {
    fit = measured(body, exact());
  } else {
    const auto measure = [&] { return toNumbers(measured(body, exact())); };
    std::vector<double> kept = cache.numbers(contentOf(body), "measures", measure);
    if (kept.size() != 3) kept = measure();
    fit.hullExcess = kept[0];
    if (kept[1] != 0.0) fit.volumeRatio = kept[1];
    fit.closed = kept[2] != 0.0;
  }
  fit.volumeExcess = fit.hullExcess + body.cover.max;
  return fit;
}

}  // namespace fcl_stpbv::report
