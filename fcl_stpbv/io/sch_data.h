// The contents of a file in sch-core's format, field by field, before any check.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace fcl_stpbv::detail::sch {

/// A cone or plane that bounds a patch's region of normals, and the patch past it.
struct Border {
  int id;
  double cosine;  ///< 0 for a plane
  Eigen::Vector3d axis;
};

struct Vertex {
  int line;
  double radius;
  Eigen::Vector3d centre;
  std::vector<Border> tori;
};

struct Face {
  int line;
  double radius;
  Eigen::Vector3d centre;
  std::array<Eigen::Vector3d, 3> corner;
  std::array<Border, 3> side;  ///< from corner 1 to 2, from 2 to 3, from 3 to 1
};

struct Torus {
  int line;
  bool real;  ///< false if both face spheres coincide: the inner edge of a k-gon's fan
  double circle, tube;
  Eigen::Vector3d middle, axis;
  std::array<Border, 2> cone;   ///< towards vertices i and j
  std::array<Border, 2> plane;  ///< towards faces f1 and f2
};

/// The ids count the vertices first, then the faces, then the real tori, in the order of the file.
struct File {
  std::string name;
  double r, R;
  std::vector<Vertex> vertices;
  std::vector<Face> faces;
  std::vector<Torus> tori;
  int digits;  ///< largest number of significant digits of any number in the file

  int firstFace() const { return static_cast<int>(vertices.size()); }
  int firstTorus() const { return firstFace() + static_cast<int>(faces.size()); }
  /// Relative error of a number printed with `digits` digits.
  double rounding() const;
  [[noreturn]] void fail(int line, const std::string& message) const;
};

File parse(std::string_view text, const std::string& name);

/// Checks the consistency of all redundant data in the file. Returns the vertices of each triangle. @throws
/// Error at the first contradiction.
std::vector<std::array<int, 3>> check(const File& file);

}  // namespace fcl_stpbv::detail::sch
