// Hulls for Bullet, and its distance of two of them. Only for programs that are built with Bullet.
#pragma once

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <Eigen/Geometry>

#include "fcl_stpbv/convex/hull_graph.h"

namespace fcl_stpbv::benchmark {

inline btVector3 toBullet(const Eigen::Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

inline btTransform toBullet(const Eigen::Isometry3d& pose) {
  btMatrix3x3 rotation;
  for (int i = 0; i < 3; ++i) rotation[i] = toBullet(Eigen::Vector3d(pose.linear().row(i)));
  return btTransform(rotation, toBullet(Eigen::Vector3d(pose.translation())));
}

/// Without margins: the same polyhedra that FCL gets.
inline void fill(btConvexHullShape& shape, const detail::HullGraph& hull) {
  for (int v = 0; v < hull.vertexCount(); ++v) shape.addPoint(toBullet(hull.point(v) + hull.centre()), false);
  shape.recalcLocalAabb();
  shape.setMargin(0);
}

/// The nearest points of two hulls by Bullet's GJK; no result if they overlap.
inline btPointCollector nearestPoints(const btConvexHullShape& a, const btTransform& poseA,
                                      const btConvexHullShape& b, const btTransform& poseB,
                                      btVoronoiSimplexSolver& simplex) {
  btGjkPairDetector detector(&a, &b, &simplex, nullptr);
  btGjkPairDetector::ClosestPointInput input;
  input.m_transformA = poseA;
  input.m_transformB = poseB;
  btPointCollector result;
  detector.getClosestPoints(input, result, nullptr);
  return result;
}

}  // namespace fcl_stpbv::benchmark
