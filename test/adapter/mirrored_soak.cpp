// Hulls and their mirror images in mirrored poses: counts how often FCL and this library are wrong in a
// number of random queries. Usage: mirrored_soak [queries] [seed]
#include <fcl/narrowphase/distance.h>

#include <cstdio>
#include <cstdlib>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/polyhedral_witness.h"
#include "test/adapter/mirrored_pairs.h"
#include "test/reference/arguments.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;

int main(int argc, char** argv) {
  const test::Arguments arguments(argc, argv, "[QUERIES [SEED]]", 2);
  const long queries = arguments.number(1, 300000L);
  test::MirroredPairs pairs(arguments.number(2, std::uint64_t{1}));
  long apart = 0, solved = 0, fclWrong = 0, witnessOpen = 0, answerOpen = 0;
  double fclWorst = 0, witnessWorst = 0, answerWorst = 0;
  for (long i = 0; i < queries; ++i) {
    if (i % 1000 == 0) pairs.nextShape();
    pairs.nextPose();
    const PolyhedralWitness w =
        polyhedralWitness(pairs.hull(), pairs.pose(), pairs.mirrorHull(), pairs.mirrorPose());
    if (w.verdict == PolyhedralWitness::Verdict::overlapping) continue;
    ++apart;
    witnessWorst = std::max(witnessWorst, w.upper - w.lower);
    if (!(w.upper - w.lower <= 1e-12)) ++witnessOpen;

    const DistanceAnswer d = distance(pairs.geometry(), pairs.pose(), pairs.mirror(), pairs.mirrorPose());
    if (d.status == DistanceStatus::local)
      continue;  // the smooth bodies, which exceed their polyhedra, overlap
    ++solved;
    answerWorst = std::max(answerWorst, d.upper - d.lower);
    if (d.status != DistanceStatus::exact || !(d.upper - d.lower <= 1e-12)) ++answerOpen;

    fcl::DistanceRequestd request(true, false, 0, 0, 1e-10);
    fcl::DistanceResultd result;
    const double f =
        fcl::distance(&pairs.geometry(), pairs.pose(), &pairs.mirror(), pairs.mirrorPose(), request, result);
    if (!(std::abs(f - w.upper) <= 1e-6)) ++fclWrong;
    fclWorst = std::max(fclWorst, std::abs(f - w.upper));
  }
  const double n = static_cast<double>(apart);
  std::printf("%ld mirrored pairs apart of %ld\n", apart, queries);
  std::printf("  fcl::distance, tolerance 1e-10   %5.2f %% off by more than 1e-6 m, worst %.3g m\n",
              100 * static_cast<double>(fclWrong) / n, fclWorst);
  std::printf("  polyhedral witness               %ld with a gap above 1e-12 m, widest %.2g m\n", witnessOpen,
              witnessWorst);
  std::printf("  fcl_stpbv::distance              %ld of %ld not exact to 1e-12 m, widest %.2g m\n",
              answerOpen, solved, answerWorst);
  return witnessOpen + answerOpen == 0 ? 0 : 1;
}
