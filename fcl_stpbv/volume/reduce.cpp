// Makes a volume with few vertices, within a limit on the over-cover:
// 1. try a sphere, then a spindle along the long axis;
// 2. else add the points that stick out most as vertices, a sixteenth more at a time. Enlarge r by what still
//    sticks out. Repeat until the limit is kept;
// 3. then remove each vertex that is not needed within the limit.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>

#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/covered_hull.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/minimum_ball.h"
#include "fcl_stpbv/volume/rolling_ball.h"
#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;
using Cloud = std::vector<Vector3d>;

class Reducer {
 public:
  Reducer(const Cloud& points, const StpBvOptions& options, double budget)
      : options_(options), budget_(budget), full_(StpBv::build(points, options)), excess_(points) {
    for (const int i : convexHull(points).vertices) hull_.push_back(points[at(i)]);
    const double own = excess_.max(*full_);
    if (!(own <= budget))
      throw Error(formatted(
          "an over-cover of %.9g m cannot be reached: with r = %.9g m and R = %.9g m all points give %.9g m; "
          "allow more or choose a smaller r or a larger R",
          budget, options.r, options.R, own));
  }

  StpBv::Ptr run() {
    for (const Cloud& simple : {sphere(), spindle()})
      if (const StpBv::Ptr volume = cover(simple)) return volume;
    const StpBv::Ptr grown = grow();
    return grown ? thin(grown) : full_;
  }

 private:
  // How far a point sticks out of the margin (m): its height over the surface that lies `options_.r` further
  // in.
  double sticksOut(const StpBv& volume, const Vector3d& p) const {
    return signedDistance(volume, p) + options_.r;
  }

  // The same for all points of the hull. A vertex lies below the surface by the volume's own r.
  std::vector<double> sticksOut(const StpBv& volume) const {
    const auto before = [](const Vector3d& a, const Vector3d& b) {
      return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
    };
    Cloud vertices = volume.vertices();
    std::sort(vertices.begin(), vertices.end(), before);
    std::vector<double> heights;
    for (const Vector3d& p : hull_)
      heights.push_back(std::binary_search(vertices.begin(), vertices.end(), p, before)
                            ? options_.r - volume.radii().r
                            : sticksOut(volume, p));
    return heights;
  }

  // The volume of some of the points; null if it cannot be built, for example near the smallest R. Then the
  // volume of all points is used.
  static StpBv::Ptr tried(const Cloud& vertices, const StpBvOptions& options) {
    try {
      return StpBv::build(vertices, options);
    } catch (const Error&) {
      return nullptr;
    }
  }

  // The volume with these vertices, with r enlarged until it covers all points with the margin. Null if that
  // is impossible, exceeds the limit, or needs an r above `most`. The point `first` is tested before the
  // others.
  StpBv::Ptr cover(const Cloud& vertices, double most = kInfinity, const Vector3d* first = nullptr) const {
    StpBvOptions grown = options_;
    // A larger r makes rho smaller and the core rounder, so the first growth is at most a little too much.
    for (int round = 0; round < 20; ++round) {
      if (grown.r > most || grown.R <= StpBv::smallestR(vertices, grown.r)) return nullptr;
      const StpBv::Ptr volume = tried(vertices, grown);
      if (!volume || (first && grown.r + sticksOut(*volume, *first) > most)) return nullptr;
      const std::vector<double> heights = sticksOut(*volume);
      const double height = *std::max_element(heights.begin(), heights.end());
      if (height <= 0) return excess_.max(*volume) <= budget_ ? volume : nullptr;
      grown.r += height + 1e-15;
    }
    return nullptr;
  }

  // cover() for some of the points. The over-cover is at least r, so no r above the limit is tried. Most
  // failures are at the point that was just removed (`dropped`), if there is one.
  StpBv::Ptr coverFrom(const Cloud& points, const Vector3d* dropped = nullptr) const {
    return cover(points, budget_, dropped);
  }

  Cloud sphere() const { return {minimumEnclosingBall(hull_).centre}; }

  // The segment along the cloud's long axis; its ends are moved inwards if that covers the cloud more
  // tightly.
  Cloud spindle() const {
    Vector3d mean = Vector3d::Zero();
    for (const Vector3d& p : hull_) mean += p / static_cast<double>(hull_.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Vector3d& p : hull_) spread += (p - mean) * (p - mean).transpose();
    const Vector3d axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
    const Vector3d centre = minimumEnclosingBall(hull_).centre;
    double low = 0, high = 0, across = 0;
    for (const Vector3d& p : hull_) {
      const double along = (p - centre).dot(axis);
      low = std::min(low, along), high = std::max(high, along);
      across = std::max(across, (p - centre - along * axis).norm());
    }
    Cloud best = {centre + low * axis, centre + high * axis};
    for (double inset = 0.25; inset <= 1; inset += 0.25) {
      const double in = std::min(inset * across, 0.45 * (high - low));
      const Cloud trial = {centre + (low + in) * axis, centre + (high - in) * axis};
      if (cover(trial)) best = trial;
    }
    return best;
  }

  // Adds the points that stick out most, a sixteenth more at a time, until the limit is kept. Null if that
  // needs as many vertices as the full volume has, or if the volume cannot be built.
  StpBv::Ptr grow() const {
    Cloud chosen = {hull_[0]};
    while (static_cast<int>(chosen.size()) < full_->vertexCount()) {
      const StpBv::Ptr volume = tried(chosen, options_);
      if (!volume) return nullptr;
      const std::vector<double> heights = sticksOut(*volume);
      std::vector<std::size_t> order(hull_.size());
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::sort(order.begin(), order.end(),
                [&](std::size_t i, std::size_t j) { return heights[i] > heights[j]; });
      // The largest height is added to r. If it alone exceeds what the limit leaves, there is no need to try.
      if (heights[order[0]] <= budget_ - options_.r)
        if (const StpBv::Ptr covering = coverFrom(chosen)) return covering;
      const std::size_t more = 1 + chosen.size() / 16;
      for (std::size_t k = 0; k < std::min(more, order.size()) && heights[order[k]] > 0; ++k)
        chosen.push_back(hull_[order[k]]);
      if (heights[order[0]] <= 0) break;
    }
    return nullptr;
  }

  // Drops each vertex that the budget can spare.
  StpBv::Ptr thin(StpBv::Ptr best) const {
    for (int i = 0; i < best->vertexCount() && best->vertexCount() > 1;) {
      Cloud fewer = best->vertices();
      const Vector3d dropped = fewer[at(i)];
      fewer.erase(fewer.begin() + i);
      const StpBv::Ptr trial = coverFrom(fewer, &dropped);
      if (trial && trial->vertexCount() < best->vertexCount())
        best = trial;
      else
        ++i;
    }
    return best;
  }

  StpBvOptions options_;
  double budget_;
  StpBv::Ptr full_;
  CoveredHull excess_;
  Cloud hull_;  // the points that matter: vertices of the convex hull
};

}  // namespace

StpBv::Ptr reduce(const std::vector<Vector3d>& points, const StpBvOptions& options, double overCover) {
  return Reducer(points, options, overCover).run();
}

}  // namespace fcl_stpbv
