// The ways to a distance that are tried, behind one interface.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "test/reference/stability/situation.h"

namespace fcl_stpbv::stability {

/// What came back from one query. Plain bytes: it passes through a pipe.
struct Answer {
  enum class Kind : int {
    none,       ///< nothing came back
    distance,   ///< a distance; its sign tells overlap
    apart,      ///< no more than that they are apart
    overlap,    ///< no more than that they overlap
    refusal,    ///< it says that it has no answer
    exception,  ///< it threw
    abort,      ///< it ended the process
    hang,       ///< it did not come back
  };
  Kind kind = Kind::none;
  double distance = 0;
  double lower = -std::numeric_limits<double>::infinity();  ///< bounds of methods that give any
  double upper = std::numeric_limits<double>::infinity();
  double normal[3] = {0, 0, 0};                 ///< from a to b
  double point[2][3] = {{0, 0, 0}, {0, 0, 0}};  ///< witness points
  bool hasPoints = false;
  bool onlyLocal = false;  ///< it says that the depth may not be the least
};

inline void put(const Eigen::Vector3d& v, double (&to)[3]) { Eigen::Map<Eigen::Vector3d>(to, 3) = v; }

/// One way to ask about the two bodies of a situation; made anew for each situation.
class Contestant {
 public:
  virtual ~Contestant() = default;
  virtual Answer query(const Placement& at) = 0;
};

struct Method {
  std::string id;     ///< in machine-readable output
  std::string title;  ///< in tables and pictures
  bool smooth;        ///< asked about the STP-BVs; else about the polyhedra
  bool isSigned;      ///< claims to know how deep an overlap is
  std::unique_ptr<Contestant> (*make)(const Situation&);
};

/// All methods built in; Bullet's are missing where Bullet was not found.
std::vector<Method> allMethods();

std::unique_ptr<Contestant> bullet(const Situation& situation);  ///< null without Bullet
/// GJK with EPA, or MPR, on the corners, libccd's own tolerances set to 1e-10.
std::unique_ptr<Contestant> libccdEpa(const Situation& situation);
std::unique_ptr<Contestant> libccdMpr(const Situation& situation);

}  // namespace fcl_stpbv::stability
