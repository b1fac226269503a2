// Bodies of FCL that several tests and benchmarks use: a volume as FCL's geometry, a link, bumpy ground.
#pragma once

#include <fcl/geometry/bvh/BVH_model.h>

#include <memory>
#include <vector>

#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "test/reference/shapes.h"

namespace fcl_stpbv::test {

inline std::shared_ptr<StpBvGeometry> geometryOf(const Cloud& cloud, double r = 0.01, double R = 10) {
  return std::make_shared<StpBvGeometry>(StpBv::build(cloud, {r, R}));
}

inline std::shared_ptr<StpBvGeometry> link(double r = 0.01, double R = 10) {
  return geometryOf(randomHull(20, {0.2, 0.15, 0.1}, 3), r, R);
}

template <typename BV>
std::shared_ptr<fcl::BVHModel<BV>> meshOf(const std::vector<Eigen::Vector3d>& points,
                                          const std::vector<fcl::Triangle>& triangles) {
  auto mesh = std::make_shared<fcl::BVHModel<BV>>();
  mesh->beginModel();
  mesh->addSubModel(points, triangles);
  mesh->endModel();
  return mesh;
}

/// Ground of `squares` by `squares` squares, 2.4 m wide, whose corners are up to `height` high or deep, so
/// that faces, edges and tops all become the nearest element.
template <typename BV>
std::shared_ptr<fcl::BVHModel<BV>> bumpyGround(std::size_t squares, double height) {
  std::vector<Eigen::Vector3d> points;
  std::vector<fcl::Triangle> triangles;
  const double side = 2.4 / static_cast<double>(squares);
  Random random(4);
  for (std::size_t i = 0; i <= squares; ++i)
    for (std::size_t j = 0; j <= squares; ++j)
      points.emplace_back(side * static_cast<double>(i) - 1.2, side * static_cast<double>(j) - 1.2,
                          random.uniform(-height, height));
  for (std::size_t i = 0; i < squares; ++i)
    for (std::size_t j = 0; j < squares; ++j) {
      const std::size_t p = i * (squares + 1) + j, q = p + squares + 1;
      triangles.emplace_back(p, q, p + 1);
      triangles.emplace_back(q, q + 1, p + 1);
    }
  return meshOf<BV>(points, triangles);
}

}  // namespace fcl_stpbv::test
