// The volume of a link's mesh: from the cache, else built with the link's r and R, fitted if asked. With an
// over-cover budget R is doubled until the volume keeps to it, then reduce() drops vertices.
#include "fcl_stpbv/robot/link_volume.h"

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/volume/reduce.h"

namespace fcl_stpbv::detail {
namespace {

using Points = std::vector<Eigen::Vector3d>;

// Whether r or R of a link's bodies follow the body's size.
bool areFitted(const GeometryOptions& options, const std::string& link) {
  return options.links.count(link) == 0 && (options.fitr || options.fitR);
}

// One mesh on its way to a volume; the points are read when they are needed, which with a warm cache may be
// never.
class VolumeMaker {
 public:
  VolumeMaker(const ShapeSource& source, VolumeCache& cache, Body& body)
      : source_(source), cache_(cache), body_(body) {}

  void make(const GeometryOptions& options, const std::string& link, double budget) {
    const VolumeKey key = volumeKey(options, link, source_.content);
    body_.volume = cache_.volume(key.content, key.radii, [&] {
      return StpBv::build(points(), radiiFor(options, link, [this] { return sizeOf(points()); }));
    });
    body_.radii = {body_.volume->radii().r, body_.volume->radii().R};
    body_.cover = keptCover(key);
    if (budget > 0) reduceTo(budget);
    body_.geometry = std::make_shared<StpBvGeometry>(body_.volume);
    body_.centre = body_.volume->centre();
    body_.radius = body_.volume->enclosingRadius();
  }

 private:
  const Points& points() const { return source_.points(); }

  OverCover keptCover(const VolumeKey& key) {
    std::string from;
    appendNumber(from, key.radii.r);
    from += ' ';
    appendNumber(from, key.radii.R);
    from += '\n' + key.content;
    const auto measure = [this] {
      const OverCover cover = overCover(*body_.volume);
      return std::vector<double>{cover.max, cover.mean};
    };
    std::vector<double> kept = cache_.numbers(from, "cover", measure);
    if (kept.size() != 2) kept = measure();
    return {kept[0], kept[1]};
  }

  void reduceTo(double budget) {
    constexpr double kLargest = 1e5;  // beyond it a big sphere is flat to rounding
    StpBvOptions& radii = body_.radii;
    body_.cover = overCover(*body_.volume, points());
    for (; body_.cover.max > budget && radii.R < kLargest; body_.cover = overCover(*body_.volume, points())) {
      radii.R *= 2;  // the over-cover falls towards r
      body_.volume = cache_.volume(source_.content, radii, [&] { return StpBv::build(points(), radii); });
    }
    if (body_.cover.max > budget)
      throw Error("no R keeps its over-cover within " + toDecimal(budget) +
                  " m with r = " + toDecimal(radii.r) + " m; give a larger budget or a smaller r");
    const StpBv::Ptr few = cache_.volume(source_.content + "\nreduced to " + toDecimal(budget), radii,
                                         [&] { return reduce(points(), radii, budget); });
    if (few->vertexCount() >= body_.volume->vertexCount()) return;
    body_.full = body_.volume;
    body_.volume = few;
    body_.cover = overCover(*few, points());
  }

  const ShapeSource& source_;
  VolumeCache& cache_;
  Body& body_;
};

}  // namespace

VolumeKey volumeKey(const GeometryOptions& options, const std::string& link, const std::string& content) {
  if (!areFitted(options, link)) return {content, radiiFor(options, link, nullptr)};
  return {content + (options.fitr ? "\nr fitted" : "") + (options.fitR ? "\nR fitted" : ""), options.radii};
}

StpBvOptions radiiFor(const GeometryOptions& options, const std::string& link,
                      const std::function<BodySize()>& size) {
  const auto own = options.links.find(link);
  if (own != options.links.end()) return own->second;
  if (!areFitted(options, link)) return options.radii;
  const BodySize known = size();
  const double r = options.fitr ? fittedRadii(known).r : options.radii.r;
  return {r, options.fitR ? fittedR(known.ball, r) : options.radii.R};
}

void makeVolume(const GeometryOptions& options, const std::string& link, const ShapeSource& source,
                VolumeCache& cache, Body& body) {
  const auto budget = options.budgets.find(link);
  VolumeMaker(source, cache, body)
      .make(options, link, budget == options.budgets.end() ? options.overCoverBudget : budget->second);
}

}  // namespace fcl_stpbv::detail
