// The methods of computing a distance that are tested, behind one interface.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "test/reference/stability/situation.h"

namespace fcl_stpbv::stability {

/// The result of one query. It consists of plain bytes, because it is sent through a pipe.
struct Answer {
  enum class Kind : int {
    none,       ///< no result came back
    distance,   ///< a distance; its sign shows an overlap
    apart,      ///< only that they are apart
    overlap,    ///< only that they overlap
    refusal,    ///< the method reports that it has no answer
    exception,  ///< the method threw
    abort,      ///< the method ended the process
    hang,       ///< the method did not return
  };
  Kind kind = Kind::none;
  double distance = 0;
  double lower = -std::numeric_limits<double>::infinity();  ///< bounds of methods that give any
  double upper = std::numeric_limits<double>::infinity();
  double normal[3] = {0, 0, 0};                 ///< from a to b
  double point[2][3] = {{0, 0, 0}, {0, 0, 0}};  ///< witness points
  bool hasPoints = false;
  bool onlyLocal = false;  ///< the method reports that the depth may not be the least
};

inline void put(const Eigen::Vector3d& v, double (&to)[3]) { Eigen::Map<Eigen::Vector3d>(to, 3) = v; }

/// A method with the two bodies of a situation. One is made for each situation.
class Contestant {
 public:
  virtual ~Contestant() = default;
  virtual Answer query(const Placement& at) = 0;
};

struct Method {
  std::string id;     ///< in machine-readable output
  std::string title;  ///< in tables and pictures
  bool smooth;        ///< whether it is given the STP-BVs; otherwise the polyhedra
  bool isSigned;      ///< whether it claims to know the depth of an overlap
  std::unique_ptr<Contestant> (*make)(const Situation&);
};

/// All methods that were built. Bullet's are missing if Bullet was not found.
std::vector<Method> allMethods();

std::unique_ptr<Contestant> bullet(const Situation& situation);  ///< null without Bullet
/// GJK with EPA, or MPR, on the corners, with libccd's own tolerances set to 1e-10.
std::unique_ptr<Contestant> libccdEpa(const Situation& situation);
std::unique_ptr<Contestant> libccdMpr(const Situation& situation);

}  // namespace fcl_stpbv::stability
