// Checks transforms of COLLADA's nodes. assimp does not normalise the axis of a <rotate>, uses the directions
// of a <lookat> as they are, and leaves out the last row of a <matrix>. So the body would be stretched,
// sheared, flat or of another size.
#include "fcl_stpbv/mesh/collada_transforms.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <vector>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/collada_values.h"
#include "fcl_stpbv/mesh/xml_text.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;
using tinyxml2::XMLElement;

// Tolerance for the length of an axis and for a right angle. Such an error stretches the body by 0.0004 % at
// most. Numbers with six digits keep the tolerance.
constexpr double kSlack = 1e-6;

Vector3d vectorAt(const std::vector<double>& numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

void checkRotation(const XMLElement& element, const std::vector<double>& numbers, const std::string& name) {
  const double length = vectorAt(numbers, 0).norm();
  if (numbers[3] == 0 || std::abs(length - 1) <= kSlack) return;
  throw Error(
      xmlPlace(element, name) + "<rotate> has an axis of length " + std::to_string(length) +
      ", expected a unit vector; write it with at least six digits, or export the node with a <matrix>");
}

void checkView(const XMLElement& element, const std::vector<double>& numbers, const std::string& name) {
  const Vector3d view = vectorAt(numbers, 3) - vectorAt(numbers, 0), up = vectorAt(numbers, 6);
  if (view.norm() > 0 && up.norm() > 0 && std::abs(view.normalized().dot(up.normalized())) <= kSlack) return;
  throw Error(
      xmlPlace(element, name) +
      "<lookat> must have a point to look at that differs from its own, and an up direction at right angles "
      "to that view; export the node with a <matrix>");
}

// A matrix written column by column has its translation in the last row.
void checkMatrix(const XMLElement& element, const std::vector<double>& numbers, const std::string& name) {
  if (numbers[12] == 0 && numbers[13] == 0 && numbers[14] == 0 && numbers[15] == 1) return;
  throw Error(xmlPlace(element, name) +
              "<matrix> must have 0 0 0 1 as its last row; write it row by row, the translation at the ends "
              "of the first three");
}

}  // namespace

void addColladaTransform(const XMLElement& element, const std::string& name, ColladaReach& reach) {
  static const std::map<std::string_view, std::size_t> kTransforms{
      {"lookat", 9}, {"matrix", 16}, {"rotate", 4}, {"scale", 3}, {"translate", 3}};
  const std::string_view kind = element.Name();
  if (kind == "skew")
    throw Error(xmlPlace(element, name) + "<skew> is not read; export the node with a <matrix>");
  const auto transform = kTransforms.find(kind);
  if (transform == kTransforms.end()) return;
  const std::vector<double> numbers = numbersOf(element, name);
  if (numbers.size() != transform->second)
    refuseCollada(
        element,
        "has " + std::to_string(numbers.size()) + " numbers, expected " + std::to_string(transform->second),
        name);
  if (kind == "rotate") checkRotation(element, numbers, name);
  if (kind == "matrix") checkMatrix(element, numbers, name);
  if (kind == "lookat") checkView(element, numbers, name);
  if (kind == "translate" || kind == "lookat") {
    reach.far += reach.stretch * vectorAt(numbers, 0).norm();
  } else if (kind == "scale") {
    reach.stretch *= vectorAt(numbers, 0).cwiseAbs().maxCoeff();
  } else if (kind == "matrix") {
    reach.far += reach.stretch * Vector3d(numbers[3], numbers[7], numbers[11]).norm();
    const auto row = [&](std::size_t first) { return vectorAt(numbers, first).norm(); };
    reach.stretch *= std::max({row(0), row(4), row(8)});  // to within a factor of 1.8
  }
}

}  // namespace fcl_stpbv::detail
