// How far a link's hull exceeds its mesh (parts/mesh_excess.h) and, with the over-cover, how far its volume
// does.
#include "fcl_stpbv/report/mesh_fit.h"

#include "fcl_stpbv/parts/mesh_excess.h"

namespace fcl_stpbv::report {

MeshFit meshFit(const Body& body, const ExactBody& exact) {
  MeshFit fit;
  if (body.partOf >= 0)
    fit.hullExcess = body.openExcess;
  else if (const MeshSolid* solid = exact.solid())
    fit.hullExcess = hullExcess(solid->pieces().vertices, *solid, quickExcess(false)).upper;
  fit.volumeExcess = fit.hullExcess + body.cover.max;
  if (body.volume && body.partOf < 0)
    fit.volumeRatio =
        enclosedVolume(*body.volume) / (body.primitive ? body.primitive->computeVolume() : exact.volume());
  return fit;
}

}  // namespace fcl_stpbv::report
