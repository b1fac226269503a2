// See bodies.h.
#include "bodies.h"

#include <algorithm>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv {
namespace {

const char* const kObstacles = "obstacles";

/// Whether the length is to be fitted to each body. @throws Error naming the argument.
bool isAuto(const BodyOptions::Length& length, const char* name) {
  const auto* word = std::get_if<std::string>(&length);
  if (word && *word != "auto")
    throw Error(std::string(name) + ": got \"" + *word + "\", expected a length (m) or \"auto\"");
  return word != nullptr;
}

}  // namespace

GeometryOptions BodyOptions::ofAll() const {
  GeometryOptions options;
  options.fitSmallRadius = isAuto(r, "r");
  options.fitBigRadius = R ? isAuto(*R, "R") : options.fitSmallRadius;
  if (!options.fitSmallRadius) options.radii.r = std::get<double>(r);
  if (!options.fitBigRadius && R) options.radii.R = std::get<double>(*R);
  return options;
}

std::vector<std::string> BodyOptions::flatNames() const {
  if (const auto* one = std::get_if<std::string>(&flat)) return {*one};
  return std::get<std::vector<std::string>>(flat);
}

GeometryOptions BodyOptions::ofRobot(bool obstacles) const {
  GeometryOptions options = ofAll();
  for (const auto& [name, lengths] : links) {
    const std::string of = "links: \"" + name + "\": ";
    if (lengths.size() < 2 || lengths.size() > 3)
      throw Error(of + "got " + std::to_string(lengths.size()) +
                  " numbers, expected (r, R) or (r, R, over-cover) in metres");
    if (!(lengths[1] > lengths[0])) throw Error(of + "R must be larger than r");
    options.links[name] = {lengths[0], lengths[1]};
    if (lengths.size() == 3) options.budgets[name] = lengths[2];
  }
  for (const std::string& name : flatNames()) {
    if (name == kObstacles && !obstacles) throw Error("flat: there are no obstacles; give their URDF");
    if (name == kObstacles) continue;
    if (links.count(name) > 0)
      throw Error("flat: \"" + name +
                  "\" has r and R in links, which flat meshes do not have; leave one out");
    options.flatLinks.insert(name);
  }
  return options;
}

GeometryOptions BodyOptions::ofObstacles() const {
  GeometryOptions options = ofAll();
  const std::vector<std::string> names = flatNames();
  options.flat = std::find(names.begin(), names.end(), kObstacles) != names.end();
  return options;
}

}  // namespace fcl_stpbv
