// Left and right limb of the HRP-2-style robot in mirrored poses, as in every symmetric motion: counts how
// often FCL is wrong on the polyhedra, and checks that this library is exact on the volumes around them, also
// with swapped arguments. mirrored_limbs [QUERIES] [SEED]
#include <fcl/narrowphase/distance.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/polyhedral_witness.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "test/reference/arguments.h"
#include "test/reference/reference.h"
#include "test/reference/source_folder.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

int main(int argc, char** argv) {
  const Arguments arguments(argc, argv, "[QUERIES [SEED]]", 2);
  const long queries = arguments.number(1, 300000L);
  Random random(arguments.number(2, std::uint64_t{1}));
  const Vector3d mirror(1, -1, 1);
  const Eigen::Matrix3d across = mirror.asDiagonal();

  struct Limb {
    StpBv::Ptr left, right;
    std::shared_ptr<StpBvGeometry> leftGeometry, rightGeometry;
  };
  std::vector<Limb> limbs;
  for (const char* link : {"LLEG_LINK2.stl", "LLEG_LINK3.dae", "LLEG_LINK5.obj", "LARM_LINK2.stl",
                           "LARM_LINK4.stl", "LARM_LINK6.stl"}) {
    const std::string file = test::sourceFolder() + "/data/hrp2_style/meshes/" + link;
    Limb limb{StpBv::build(loadPoints(file)), StpBv::build(loadPoints(file, mirror)), nullptr, nullptr};
    limb.leftGeometry = std::make_shared<StpBvGeometry>(limb.left);
    limb.rightGeometry = std::make_shared<StpBvGeometry>(limb.right);
    limbs.push_back(limb);
  }

  long apart = 0, fclWrong = 0, notExact = 0, swapped = 0, checked = 0;
  double fclWorst = 0, widest = 0, referenceWorst = 0, normalWorst = 0;
  for (long i = 0; i < queries; ++i) {
    const Limb& limb = limbs[static_cast<std::size_t>(i) % limbs.size()];
    const Eigen::Matrix3d rotation = random.rotation();
    const Vector3d t(random.uniform(-0.5, 0.5), random.uniform(0.08, 0.5), random.uniform(-0.5, 0.5));
    const Eigen::Isometry3d left = pose(rotation, t), right = pose(across * rotation * across, across * t);

    const Distance d = distance(*limb.left, left, *limb.right, right);
    if (d.status == DistanceStatus::local) continue;  // they overlap by more than the margins
    ++apart;
    widest = std::max(widest, d.upper - d.lower);
    if (d.status != DistanceStatus::exact || !(d.upper - d.lower <= 1e-13)) ++notExact;
    const Distance back = distance(*limb.right, right, *limb.left, left);
    // Coordinates of about 1 m, rounded a dozen times. The normal's error is that divided by the distance of
    // the cores (docs/theory.md, 6).
    constexpr double kRounded = 1e-14, kMargins = 2 * 0.01;
    if (!(std::abs(back.distance - d.distance) <= kRounded) ||
        !((back.normal + d.normal).norm() <= kRounded / (d.distance + kMargins)))
      ++swapped;
    if (i % 100 == 0 && d.distance > 0) {
      ++checked;
      const ReferenceDistance r = referenceDistance(referenceBody(limb.left->vertices(), 0.01, 10, left),
                                                    referenceBody(limb.right->vertices(), 0.01, 10, right),
                                                    d.normal.cast<long double>());
      referenceWorst =
          std::max(referenceWorst, static_cast<double>(std::abs(r.distance - d.distance) + r.gap));
      normalWorst = std::max(normalWorst, (r.normal.cast<double>() - d.normal).norm());
    }

    const PolyhedralWitness w =
        polyhedralWitness(limb.leftGeometry->hull(), left, limb.rightGeometry->hull(), right);
    if (w.verdict == PolyhedralWitness::Verdict::overlapping) continue;
    fcl::DistanceResultd result;
    const double f = fcl::distance(limb.leftGeometry.get(), left, limb.rightGeometry.get(), right,
                                   fcl::DistanceRequestd(true, false, 0, 0, 1e-10), result);
    if (!(std::abs(f - w.upper) <= 1e-6)) ++fclWrong;
    fclWorst = std::max(fclWorst, std::abs(f - w.upper));
  }
  std::printf("%ld mirrored poses of %zu limbs, %ld apart\n", queries, limbs.size(), apart);
  std::printf("  fcl::distance, tolerance 1e-10: %.2f %% off by more than 1e-6 m, worst %.3g m\n",
              100.0 * static_cast<double>(fclWrong) / static_cast<double>(apart), fclWorst);
  std::printf("  fcl_stpbv::distance: %ld not exact, widest certificate %.2g m, %ld differ when swapped\n",
              notExact, widest, swapped);
  std::printf("  against the long-double reference, %ld of them: distance %.2g m, normal %.2g rad\n", checked,
              referenceWorst, normalWorst);
  return notExact + swapped == 0 && referenceWorst <= 1e-13 && normalWorst <= 1e-10 ? 0 : 1;
}
