// Agglomerative joining, as in hierarchical approximate convex decomposition (HACD; Mamou and Ghorbel, ICIP
// 2009), with the excess of the joined hull over the mesh as its cost:
// 1. triangles of one plane that share edges form a facet, and each facet is a part. If a facet is not convex
//    (an L or a ring), each of its triangles is a part;
// 2. of all pairs of parts that share an edge, join the pair whose hull has the least excess; of pairs within
//    the bound, the one whose hull has the smallest surface;
// 3. repeat until no join is within the bound and few enough parts are left. The last joins may not be the
//    best ones. So the sets of parts before them, with a few more parts, are results too.
#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/parts/part_search.h"

namespace fcl_stpbv::detail {
namespace {

// As a share of the resolution of other searches: facets that fit here fit up to rounding.
constexpr double kFiner = 0.1;
// A round mesh of small facets does not consist of a few convex bodies.
constexpr std::size_t kMostFacets = 700;

// The triangles of each facet, and which facets share an edge.
struct Facets {
  std::vector<TriangleSoup> soups;
  std::set<std::pair<int, int>> neighbours;
};

int rootOf(std::vector<int>& parent, int i) {
  while (parent[at(i)] != i) i = parent[at(i)] = parent[at(parent[at(i)])];
  return i;
}

// Adds the triangles of `soup` by facet. Triangles of the facets in `loose` are added one by one.
void append(Facets& out, const TriangleSoup& soup, const std::set<int>& loose) {
  std::map<std::pair<int, int>, std::vector<int>> atEdge;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = soup.triangles[t][k], b = soup.triangles[t][(k + 1) % 3];
      atEdge[std::minmax(a, b)].push_back(static_cast<int>(t));
    }
  std::vector<int> parent(soup.triangles.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (const auto& [edge, triangles] : atEdge)
    for (const int t : triangles)
      if (soup.facet[at(t)] == soup.facet[at(triangles[0])] && !loose.count(soup.facet[at(t)]))
        parent[at(rootOf(parent, t))] = rootOf(parent, triangles[0]);
  std::map<int, int> place;  // index of the soup of each root
  for (std::size_t t = 0; t < parent.size(); ++t) {
    const auto [found, isNew] =
        place.try_emplace(rootOf(parent, static_cast<int>(t)), static_cast<int>(out.soups.size()));
    if (isNew) out.soups.emplace_back();
    TriangleSoup& facet = out.soups[at(found->second)];
    std::array<int, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      triangle[k] = static_cast<int>(facet.points.size());
      facet.points.push_back(soup.points[at(soup.triangles[t][k])]);
    }
    facet.triangles.push_back(triangle);
    facet.facet.push_back(soup.facet[t]);
  }
  for (const auto& [edge, triangles] : atEdge)
    for (const int t : triangles) {
      const int a = place[rootOf(parent, t)], b = place[rootOf(parent, triangles[0])];
      if (a != b) out.neighbours.insert(std::minmax(a, b));
    }
}

double areaOf(const std::vector<Triangle>& surface) {
  double area = 0;
  for (const Triangle& t : surface) area += 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
  return area;
}

// The common hull of two neighbours.
struct Join {
  double excess = 0;  // over the mesh; 0 if it is within the bound
  double size = 0;
  PartPtr part;

  Join() = default;
  Join(const Part& a, const Part& b, const PartSpace& space, double bound)
      : part(std::make_shared<Part>(joined(a, b, space, {kFiner * space.fine, kInfinity, 300}))) {
    size = areaOf(part->hull.surface);
    excess = part->excess.lower <= bound ? 0 : part->excess.lower;
  }
  bool isBefore(const Join& other) const {
    return std::tie(excess, size) < std::tie(other.excess, other.size);
  }
  // If the excess may not be within the bound, measures it again more accurately. @returns whether it did.
  bool confirm(const PartSpace& space, double bound) {
    constexpr long kQueries = 10000;
    if (excess > 0 || part->excess.upper <= bound + kFiner * space.fine || part->queries == kQueries)
      return false;
    measureAgain(*part, space, {kFiner * space.fine, bound, kQueries});
    excess = part->excess.lower <= bound ? 0 : part->excess.lower;
    return true;
  }
};

// The parts that are left.
PartSearch::Parts leftOf(PartSearch::Parts parts) {
  parts.erase(std::remove(parts.begin(), parts.end(), nullptr), parts.end());
  return parts;
}

}  // namespace

std::vector<PartSearch::Parts> facetParts(const std::vector<TriangleSoup>& groups, const PartSpace& space,
                                          int most, double bound) {
  const std::size_t few = static_cast<std::size_t>(most), many = std::max<std::size_t>(16, few);
  bound = std::max(bound, 2 * kFiner * space.fine);
  Facets facets;
  PartSearch::Parts parts;
  std::set<int> loose;  // facets that are not convex, such as an L or a ring, are taken triangle by triangle
  for (const bool again : {false, true}) {
    facets = {};
    for (const TriangleSoup& group : groups) append(facets, group, loose);
    if (facets.soups.size() > kMostFacets) return {};
    parts.clear();
    for (TriangleSoup& soup : facets.soups) {
      auto leaf = std::make_shared<BspLeaf>();
      leaf->soup = std::move(soup);
      leaf->isFacet = true;
      parts.push_back(std::make_shared<Part>(makePart({leaf}, space, {kFiner * space.fine})));
      if (!again && parts.back()->excess.upper > 2 * bound) loose.insert(leaf->soup.facet.front());
    }
    if (loose.empty()) break;
  }
  std::vector<PartSearch::Parts> found;
  std::map<std::pair<int, int>, Join> joins;
  const auto add = [&](int a, int b) {
    joins[std::minmax(a, b)] = Join(*parts[at(a)], *parts[at(b)], space, bound);
  };
  for (const auto& [a, b] : facets.neighbours) add(a, b);
  std::size_t left = parts.size();
  while (left > 1 && !joins.empty()) {
    const auto best = std::min_element(
        joins.begin(), joins.end(), [](const auto& x, const auto& y) { return x.second.isBefore(y.second); });
    if (best->second.confirm(space, bound)) continue;  // it may no longer be the best one
    if (left <= many && best->second.excess > 0) {
      found.push_back(leftOf(parts));
      if (left <= few) break;
    }
    const auto [a, b] = best->first;
    parts[at(a)] = best->second.part;
    parts[at(b)] = nullptr;
    --left;
    std::set<int> around;
    for (auto j = joins.begin(); j != joins.end();) {
      const auto [i, k] = j->first;
      const bool isOld = i == a || i == b || k == a || k == b;
      if (isOld) around.insert({i, k});
      j = isOld ? joins.erase(j) : std::next(j);
    }
    for (const int other : around)
      if (other != a && other != b) add(a, other);
  }
  if (left > 2 * many) return {};  // there are many loose pieces, and joining each with each takes too long
  if (found.empty() || found.back().size() > few) found.push_back(leftOf(parts));
  return found;
}

}  // namespace fcl_stpbv::detail
