// Runs HACD:
// 1. Merge corners at the same place, because HACD needs corners that triangles share.
// 2. HACD partitions the triangles. Only the number of clusters decides.
// 3. A cluster's points are its triangles' corners.
#include "tools/bench/parts/hacd.h"

#include <hacdHACD.h>

#include <array>
#include <map>
#include <memory>

namespace fcl_stpbv::benchmark {

std::vector<std::vector<Eigen::Vector3d>> hacdClusters(const TriangleMesh& mesh, int count) {
  std::map<std::array<double, 3>, long> number;
  std::vector<HACD::Vec3<HACD::Real>> points;
  std::vector<HACD::Vec3<long>> triangles;
  for (const auto& t : mesh.triangles) {
    std::array<long, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& v = mesh.vertices[static_cast<std::size_t>(t[k])];
      const auto [place, isNew] = number.try_emplace({v.x(), v.y(), v.z()}, static_cast<long>(points.size()));
      if (isNew) points.emplace_back(v.x(), v.y(), v.z());
      corner[k] = place->second;
    }
    if (corner[0] != corner[1] && corner[1] != corner[2] && corner[2] != corner[0])
      triangles.emplace_back(corner[0], corner[1], corner[2]);
  }
  // A copy, because HACD scales the points it is given.
  const std::vector<HACD::Vec3<HACD::Real>> given = points;
  HACD::HACD hacd;
  hacd.SetPoints(points.data());
  hacd.SetNPoints(points.size());
  hacd.SetTriangles(triangles.data());
  hacd.SetNTriangles(triangles.size());
  hacd.SetNClusters(static_cast<std::size_t>(count));
  hacd.SetConcavity(1e9);    // so that only the number of clusters decides
  hacd.SetConnectDist(1e9);  // so that loose pieces are joined too
  hacd.SetCompacityWeight(0.0001);
  hacd.SetVolumeWeight(0.0);
  hacd.SetNVerticesPerCH(100);
  hacd.SetAddExtraDistPoints(true);
  hacd.SetAddFacesPoints(true);
  hacd.Compute();
  const long* partition = hacd.GetPartition();
  std::map<long, std::vector<Eigen::Vector3d>> clusters;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const long i : {triangles[t].X(), triangles[t].Y(), triangles[t].Z()}) {
      const auto& p = given[static_cast<std::size_t>(i)];
      clusters[partition[t]].emplace_back(p.X(), p.Y(), p.Z());
    }
  }
  std::vector<std::vector<Eigen::Vector3d>> out;
  for (auto& [cluster, cloud] : clusters) out.push_back(std::move(cloud));
  return out;
}

}  // namespace fcl_stpbv::benchmark
