// Pairs on which FCL stops because of equal norms are given here with their distances. Field cases are read
// from their file; their distances are here, in the file's order.
#include "test/reference/hard_cases.h"

#include <array>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace fcl_stpbv::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Isometry3d poseOf(const Quaterniond& q, const Vector3d& t) { return pose(q.toRotationMatrix(), t); }

Cloud mirrored(Cloud cloud) {
  for (Vector3d& p : cloud) p[1] = -p[1];
  return cloud;
}

}  // namespace

std::vector<HardCase> equalNormCases() {
  std::vector<HardCase> cases;
  const Quaterniond one(1, 0, 0, 0);
  const Isometry3d here = poseOf(one, {0, 0, 0});
  const Cloud unit = box(1, 1, 1), small = box(0.2, 0.2, 0.2);
  cases.push_back({"unit boxes along y", unit, unit, poseOf(one, {0, 4, 0}), here, 3, 1e-12});
  cases.push_back({"unit boxes along z", unit, unit, poseOf(one, {0, 0, 4}), here, 3, 1e-12});

  const Quaterniond aboutY(0.92387953251128674, 0, 0.38268343236508978, 0);
  const Quaterniond aboutX(0.92387953251128674, 0.38268343236508978, 0, 0);
  cases.push_back({"boxes with crossed edges that touch", small, small, poseOf(aboutY, {0, 0, 0}),
                   poseOf(aboutX, {0, 0, 0.28284271247461906}), 0, 1e-12});

  const Quaterniond q(-0.35696447415505356, -0.34355525993209235, 0.78813397709637389, 0.36522730143083632);
  cases.push_back({"boxes in one orientation", small, small, poseOf(q, {0, 0, 0}),
                   poseOf(q, {-0.23663076219973789, -0.09140831192966728, 0.33932874715329259}), 0.140824133,
                   1e-9});

  const Quaterniond turned(0.69193712937676233, 0.40055124484227378, -0.59654385900593065,
                           -0.070122275543958654);
  const Cloud sphere = geodesicSphere(0.2, 1);
  cases.push_back({"geodesic spheres in one orientation", sphere, sphere, poseOf(turned, {0, 0, 0}),
                   poseOf(turned, {0.15246778685579854, -0.31482497554014005, 0.42129384087108968}),
                   0.147585328, 1e-9});

  const std::array<Cloud, 6> tetrahedra{{{{2, -2, 1}, {2, 0, 0}, {2, 1, 0}, {-1, 0, -1}},
                                         {{2, 0, -2}, {-1, -2, 0}, {0, 0, 1}, {1, 2, 0}},
                                         {{2, 0, 2}, {1, -1, -2}, {-2, 0, 1}, {2, 0, -2}},
                                         {{2, 1, 1}, {-1, -1, -1}, {0, 1, 2}, {-1, 0, -2}},
                                         {{-1, -1, -1}, {2, 0, -2}, {2, 1, 2}, {1, 0, 0}},
                                         {{0, 1, -2}, {-1, 0, 2}, {1, -2, 0}, {1, 1, 2}}}};
  const std::array<double, 6> distances{2, 2, 4, 4, 4, 2};
  for (std::size_t i = 0; i < tetrahedra.size(); ++i)
    cases.push_back({"tetrahedron " + std::to_string(i + 1) + " and its mirror image", tetrahedra[i],
                     mirrored(tetrahedra[i]), poseOf(one, {0, 3, 0}), poseOf(one, {0, -3, 0}), distances[i],
                     1e-12});
  return cases;
}

std::vector<HardCase> fieldCases(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot open " + path);
  const std::array<double, 8> distances{-0.5747809, -0.8936539, -0.6343419,   -0.1513552,
                                        -0.8471562, -0.7977672, -0.002768032, 0};
  std::vector<HardCase> cases;
  int body = 0;
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "case") {
      cases.push_back({line, {}, {}, {}, {}, distances.at(cases.size()), 1e-6});
      body = 0;
    } else if (word == "mesh") {
      ++body;
    } else if (word == "v") {
      Vector3d p;
      words >> p[0] >> p[1] >> p[2];
      (body == 1 ? cases.back().first : cases.back().second).push_back(p);
    } else if (word == "pose") {
      Eigen::Matrix<double, 3, 4> m;
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 4; ++c) words >> m(r, c);
      (body == 1 ? cases.back().pose1 : cases.back().pose2) = pose(m.leftCols<3>(), m.col(3));
    }
  }
  return cases;
}

}  // namespace fcl_stpbv::test
