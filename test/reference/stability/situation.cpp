// Makes a body from points and facets. The size of a pair is the scale for its errors. The list of all
// situations is sorted by group, and all names in it differ.
#include "test/reference/stability/situation.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

namespace fcl_stpbv::stability {

using Eigen::Vector3d;

std::shared_ptr<const Body> makeBody(const Cloud& points, const StpBvOptions& radii,
                                     const std::vector<int>& facets) {
  auto body = std::make_shared<Body>();
  body->points = points;
  body->radii = radii;
  body->facets = facets;
  body->smooth = std::make_shared<const StpBvGeometry>(StpBv::build(points, radii));
  if (facets.empty()) {
    body->sharp = body->smooth;
    body->corners = body->smooth->getVertices();
  } else {
    int count = 0;
    for (std::size_t i = 0; i < facets.size(); i += 1 + static_cast<std::size_t>(facets[i])) ++count;
    body->sharp = std::make_shared<const fcl::Convexd>(std::make_shared<const Cloud>(points), count,
                                                       std::make_shared<const std::vector<int>>(facets));
    body->corners = points;
  }
  return body;
}

double sizeOf(const Situation& situation, const Placement& at) {
  const auto extent = [](const Body& body) {
    const StpBv& v = body.smooth->volume();
    return v.centre().norm() + v.enclosingRadius();
  };
  const double apart = (at.b.translation() - at.a.translation()).norm();
  const double size = extent(*situation.a) + extent(*situation.b) + apart;
  return std::isfinite(size) ? size : 1.0;
}

std::vector<Situation> allSituations(std::uint64_t seed, const std::string& hardCases, bool large) {
  std::vector<Situation> all;
  addContacts(all, seed);
  addMotions(all, seed);
  addDepths(all, seed);
  addBodies(all, seed, large);
  addPoses(all, seed);
  addMeshes(all, seed);
  addReports(all, hardCases);
  std::map<std::string, std::size_t> order;  // order of the groups: that of their first situations
  for (const Situation& s : all) order.emplace(s.group, order.size());
  std::stable_sort(all.begin(), all.end(),
                   [&](const Situation& s, const Situation& t) { return order[s.group] < order[t.group]; });
  std::set<std::string> names;
  for (const Situation& s : all)
    if (!names.insert(s.group + ": " + s.name).second)
      throw std::logic_error("two cases are called " + s.group + ": " + s.name);
  return all;
}

}  // namespace fcl_stpbv::stability
