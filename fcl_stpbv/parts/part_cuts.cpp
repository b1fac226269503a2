// The best ways to cut a part in two.
// 1. Candidate planes: twelve across each coordinate and principal axis and one through the point farthest
//    from the mesh, and the planes of the mesh's largest flat parts. Flat parts are found by rounding normals
//    and offsets to a grid.
// 2. Make the two hulls for every plane and sort the planes by the hulls' total volume.
// 3. Measure the excess of the halves of the first planes. Stop measuring a plane when one half alone is
//    worse than the best scores so far.
// 4. Keep the two planes with the least volume and, of the others, the two with the best score.
#include "fcl_stpbv/parts/part_cuts.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

constexpr int kSteps = 12;   // cuts across each axis
constexpr int kFacets = 30;  // number of flat parts tried

// Lowest and highest point of the part along a direction.
std::pair<double, double> reach(const Part& part, const Vector3d& n) {
  double low = n.dot(part.hull.vertices[0]), high = low;
  for (const Vector3d& v : part.hull.vertices) {
    low = std::min(low, n.dot(v));
    high = std::max(high, n.dot(v));
  }
  return {low, high};
}

struct Spread {
  Eigen::Matrix3d axes;               // principal axes of the triangles' middles, weighted by area
  std::map<int, double> areaOfFacet;  // area of the part's triangles in each facet
};

Spread spreadOf(const Part& part) {
  Spread spread;
  Vector3d sum = Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double area = 0;
  for (const auto& leaf : part.leaves) {
    for (std::size_t t = 0; t < leaf->soup.triangles.size(); ++t) {
      const auto& [i, k, l] = leaf->soup.triangles[t];
      const Vector3d &a = leaf->soup.points[at(i)], &b = leaf->soup.points[at(k)],
                     &c = leaf->soup.points[at(l)];
      const double size = 0.5 * (b - a).cross(c - a).norm();
      const Vector3d middle = (a + b + c) / 3;
      area += size;
      sum += size * middle;
      squares += size * middle * middle.transpose();
      spread.areaOfFacet[leaf->soup.facet[t]] += size;
    }
  }
  spread.axes.setIdentity();
  if (!(area > 0)) return spread;
  squares -= sum * sum.transpose() / area;
  spread.axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(squares).eigenvectors();
  return spread;
}

}  // namespace

std::vector<CutPlane> flatParts(const MeshSolid& mesh, double slack, std::vector<int>& facetOf) {
  // Normals and offsets are rounded to a grid. A flat part whose triangles fall into two cells of the grid
  // counts twice.
  constexpr double kGrid = 1e-3;
  std::map<std::array<long, 4>, int> number;
  std::vector<CutPlane> planes;
  facetOf.clear();
  for (const Triangle& t : mesh.triangles()) {
    const Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]);
    const double size = n.norm();
    const CutPlane plane{size > 0 ? Vector3d(n / size) : Vector3d::UnitZ(),
                         size > 0 ? n.dot(t[0]) / size : 0};
    const auto cellOf = [](double x, double grid) { return std::lround(x / grid); };
    const std::array<long, 4> key{cellOf(plane.normal.x(), kGrid), cellOf(plane.normal.y(), kGrid),
                                  cellOf(plane.normal.z(), kGrid), cellOf(plane.offset, 1e3 * slack)};
    const auto [place, isNew] = number.try_emplace(key, static_cast<int>(planes.size()));
    if (isNew) planes.push_back(plane);
    facetOf.push_back(place->second);
  }
  return planes;
}

std::vector<CutPlane> cutPlanes(const Part& part, const PartSpace& space) {
  const Spread spread = spreadOf(part);
  std::vector<CutPlane> planes;
  std::vector<Vector3d> axes{Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  for (int k = 0; k < 3; ++k) axes.push_back(spread.axes.col(k));
  for (const Vector3d& n : axes) {
    const auto [low, high] = reach(part, n);
    if (high - low < 1e-3 * space.size) continue;
    for (int i = 1; i <= kSteps; ++i) planes.push_back({n, low + (high - low) * i / (kSteps + 1)});
    planes.push_back({n, n.dot(part.excess.where)});
  }
  std::vector<std::pair<double, int>> facets;
  for (const auto& [facet, area] : spread.areaOfFacet) facets.push_back({area, facet});
  std::sort(facets.rbegin(), facets.rend());
  int taken = 0;
  for (const auto& [area, facet] : facets) {
    const CutPlane& plane = space.facets[at(facet)];
    const auto [low, high] = reach(part, plane.normal);
    if (plane.offset - low < 5e-4 * space.size || high - plane.offset < 5e-4 * space.size) continue;
    planes.push_back(plane);
    if (++taken == kFacets) break;
  }
  return planes;
}

const std::vector<PartCut>& PartCuts::of(const PartPtr& part, bool quick, long& spent) {
  constexpr std::size_t kByVolume = 2, kByScore = 2;
  // Planes that are looked at; the other halves have more volume.
  const std::size_t scored = quick ? 4 : 48;
  const auto [place, isNew] = cuts_.try_emplace(part.get());
  std::vector<PartCut>& ways = place->second;
  if (!isNew) return ways;
  kept_.push_back(part);
  const std::vector<CutPlane> planes = cutPlanes(*part, space_);
  std::vector<std::pair<CutHulls, std::size_t>> byVolume;
  for (std::size_t i = 0; i < planes.size(); ++i)
    if (auto hulls = hullsOfCut(*part, planes[i], space_)) byVolume.push_back({*std::move(hulls), i});
  const auto lessVolume = [](const auto& a, const auto& b) { return a.first.volume < b.first.volume; };
  const auto lessScore = [](const PartCut& a, const PartCut& b) { return a.score < b.score; };
  std::stable_sort(byVolume.begin(), byVolume.end(), lessVolume);
  if (byVolume.size() > scored) byVolume.resize(scored);
  spent += static_cast<long>(planes.size());
  std::vector<PartCut> best;  // by score
  double lastVolume = -1;
  for (auto& [hulls, i] : byVolume) {
    const double volume = hulls.volume;
    const bool another =
        volume > lastVolume * (1 + 1e-3);  // planes of nearly one place have nearly one volume
    const bool kept = ways.size() < kByVolume && another;
    const double left = part->hull.volume > 0 ? volume / part->hull.volume : 1, weight = 0.5 + 0.5 * left;
    const double bar = best.size() < kByScore ? kInfinity : best.back().score;
    auto [above, below] = cut(*part, planes[i], space_);
    if (above.empty() || below.empty()) continue;
    // A half that is worse than the bar allows rules the plane out.
    const Measure measure{kCutResolution * excessOf(part), kept ? kInfinity : bar / weight};
    const auto up =
        std::make_shared<Part>(makePart(std::move(above), std::move(hulls.above), space_, measure));
    ++spent;
    if (excessOf(up) > measure.enough) continue;
    const auto down =
        std::make_shared<Part>(makePart(std::move(below), std::move(hulls.below), space_, measure));
    ++spent;
    const auto [less, more] = std::minmax({excessOf(up), excessOf(down)});
    const PartCut split{(more + 0.5 * less) * weight + 1e-5 * space_.size * left, up, down};
    if (kept) {
      ways.push_back(split);
      lastVolume = volume;
    } else if (split.score < bar) {
      if (best.size() == kByScore) best.pop_back();
      best.insert(std::upper_bound(best.begin(), best.end(), split, lessScore), split);
    }
  }
  ways.insert(ways.end(), best.begin(), best.end());
  std::sort(ways.begin(), ways.end(), lessScore);
  return ways;
}

}  // namespace fcl_stpbv::detail
