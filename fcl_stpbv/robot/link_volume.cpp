// Makes the volume of a link's mesh: from the cache, or built with the link's r and R (or fitted ones). With
// a limit on the over-cover, R is doubled until the volume keeps it; then reduce() removes vertices.
#include "fcl_stpbv/robot/link_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/convex/hull_graph.h"
#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/number_check.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/bounding_ball.h"
#include "fcl_stpbv/volume/covered_hull.h"
#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::detail {
namespace {

using Points = std::vector<Eigen::Vector3d>;

// Whether r or R of a link's bodies are chosen by the body's size.
bool areFitted(const GeometryOptions& options, const std::string& link) {
  return options.links.count(link) == 0 && (options.fitSmallRadius || options.fitBigRadius || options.advice);
}

std::string textOf(const RadiiTask& task) {
  std::string text = task.bothRound ? "round" : "flat";
  for (const double number :
       {task.clearance, task.acceleration, task.speed, task.turning, task.period, task.distance}) {
    text += ' ';
    appendNumber(text, number);
  }
  return text;
}

// Makes the volume of one mesh. The points are read when they are needed, which with a warm cache may be
// never.
class VolumeMaker {
 public:
  VolumeMaker(const ShapeSource& source, VolumeCache& cache, Body& body)
      : source_(source), cache_(cache), body_(body) {}

  void make(const GeometryOptions& options, const std::string& link, double budget) {
    const VolumeKey key = volumeKey(options, link, source_.key);
    if (options.advice && options.links.count(link) == 0) body_.advice = keptAdvice(key, *options.advice);
    body_.volume = cache_.volume(key.content, key.radii, [&] {
      return StpBv::build(points(), body_.advice ? body_.advice->radii : radiiFor(options, link, [this] {
                            return sizeOf(points());
                          }));
    });
    body_.radii = {body_.volume->radii().r, body_.volume->radii().R};
    keepCover(key);
    if (budget > 0) reduceTo(budget);
    body_.geometry = geometryOf(body_.volume);
    body_.centre = body_.volume->centre();
    body_.radius = body_.volume->enclosingRadius();
  }

 private:
  const Points& points() const { return source_.points(); }

  // Makes FCL's geometry from the known vertices, because rolling the hull again would take longer than
  // everything else that a cached volume needs.
  std::shared_ptr<StpBvGeometry> geometryOf(const StpBv::Ptr& volume) {
    const Points& vertices = volume->vertices();
    return std::make_shared<StpBvGeometry>(
        volume, std::make_shared<const HullGraph>(vertices, cache_.convexHull(vertices)));
  }

  // Measures the over-cover. If a small R leaves corners of the hull inside the volume, also keeps the volume
  // of all points.
  void keepCover(const VolumeKey& key) {
    std::string from;
    appendNumber(from, key.radii.r);
    from += ' ';
    appendNumber(from, key.radii.R);
    from += '\n' + key.content;
    const auto measure = [this] {
      const CoveredHull hull(points());
      const OverCover cover = hull.of(*body_.volume);
      return std::vector<double>{cover.max, cover.mean, leavesNoneInside(hull.corners())};
    };
    std::vector<double> kept = cache_.numbers(from, "over-cover", measure);
    if (kept.size() != 3) kept = measure();
    body_.cover = {kept[0], kept[1]};
    if (!(kept[2] > body_.radii.R)) return;
    const StpBvOptions wide{body_.radii.r, kept[2]};
    body_.full = geometryOf(cache_.volume(source_.key, wide, [&] { return StpBv::build(points(), wide); }));
  }

  // The body's R, or a larger one if the body's R leaves corners of the hull inside the volume.
  double leavesNoneInside(const std::vector<int>& corners) const {
    StpBvOptions wide = body_.radii;
    for (StpBv::Ptr v = body_.volume; leftInside(*v, corners) > kNothing && wide.R < kLargestR;) {
      wide.R = std::min(4 * wide.R, kLargestR);
      v = StpBv::build(points(), wide);
    }
    return wide.R;
  }

  // Largest distance of a point from the hull of the volume's vertices (m). It is reached at a corner of the
  // hull of all points.
  double leftInside(const StpBv& volume, const std::vector<int>& corners) const {
    using Corner = std::array<double, 3>;
    std::set<Corner> kept;
    for (const Eigen::Vector3d& v : volume.vertices()) kept.insert({v.x(), v.y(), v.z()});
    const Shape hull = Shape::polytopeOf(volume.vertices().data(), volume.vertexCount());
    double most = 0;
    for (const int i : corners) {
      const Eigen::Vector3d& v = points()[at(i)];
      if (kept.count({v.x(), v.y(), v.z()}) > 0) continue;
      const Distance found = distance(Shape::sphere(0), Eigen::Isometry3d(Eigen::Translation3d(v)), hull,
                                      Eigen::Isometry3d::Identity());
      if (found.status != DistanceStatus::invalid) most = std::max(most, found.distance);
    }
    return most;
  }

  RadiiAdvice keptAdvice(const VolumeKey& key, const RadiiTask& task) {
    // Stands for an infinite least clearance, because the cache keeps only finite numbers.
    constexpr double kNever = -1;
    const auto ask = [&] {
      const RadiiAdvice a = adviseRadii(points(), task);
      return std::vector<double>{a.radii.r,
                                 a.radii.R,
                                 double(a.meetsBoth),
                                 a.acceleration,
                                 a.overCover,
                                 a.perPeriod,
                                 std::isfinite(a.leastClearance) ? a.leastClearance : kNever};
    };
    std::vector<double> kept = cache_.numbers(key.content, "advice 3", ask);
    if (kept.size() != 7) kept = ask();
    return {{kept[0], kept[1]}, kept[2] != 0, kept[3], kept[4], kept[5], kept[6] < 0 ? kInfinity : kept[6]};
  }

  void reduceTo(double budget) {
    StpBvOptions& radii = body_.radii;
    const CoveredHull hull(points());
    body_.cover = hull.of(*body_.volume);
    for (; body_.cover.max > budget && radii.R < kLargestR; body_.cover = hull.of(*body_.volume)) {
      radii.R = std::min(2 * radii.R, kLargestR);  // a larger R brings the over-cover closer to r
      body_.volume = cache_.volume(source_.key, radii, [&] { return StpBv::build(points(), radii); });
    }
    if (body_.cover.max > budget)
      throw Error("no R up to " + toDecimal(kLargestR) + " m keeps its over-cover within " +
                  toDecimal(budget) + " m with r = " + toDecimal(radii.r) +
                  " m; give a larger budget or a smaller r");
    const StpBv::Ptr few = cache_.volume(source_.key + "\nreduced to " + toDecimal(budget), radii,
                                         [&] { return reduce(points(), radii, budget); });
    if (few->vertexCount() >= body_.volume->vertexCount()) return;
    if (!body_.full) body_.full = geometryOf(body_.volume);
    body_.volume = few;
    body_.cover = hull.of(*few);
  }

  static constexpr double kNothing = 1e-5;  // tolerance of a distance to the hull (m)

  const ShapeSource& source_;
  VolumeCache& cache_;
  Body& body_;
};

}  // namespace

VolumeKey volumeKey(const GeometryOptions& options, const std::string& link, const std::string& meshKey) {
  if (!areFitted(options, link)) return {meshKey, radiiFor(options, link, nullptr)};
  if (options.advice) return {meshKey + "\nadvised " + textOf(*options.advice), options.radii};
  return {meshKey + (options.fitSmallRadius ? "\nr fitted" : "") + (options.fitBigRadius ? "\nR fitted" : ""),
          options.radii};
}

StpBvOptions radiiFor(const GeometryOptions& options, const std::string& link,
                      const std::function<BodySize()>& size) {
  const auto own = options.links.find(link);
  if (own != options.links.end()) return own->second;
  return withFitted(options.radii, options.fitSmallRadius, options.fitBigRadius, size);
}

void makeVolume(const GeometryOptions& options, const std::string& link, const ShapeSource& source,
                VolumeCache& cache, Body& body) {
  const auto budget = options.budgets.find(link);
  VolumeMaker(source, cache, body)
      .make(options, link, budget == options.budgets.end() ? options.overCoverBudget : budget->second);
}

void makeHull(const Points& points, Body& body) {
  body.geometry = hullGeometry(points);
  const BoundingBall ball = boundingBall(*body.geometry);
  body.centre = ball.centre;
  body.radius = ball.radius;
}

}  // namespace fcl_stpbv::detail
