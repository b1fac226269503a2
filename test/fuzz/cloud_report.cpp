// How the builder, verify() and the measures do on nasty clouds, the figures of docs/stability.md:
//   cloud_report [CLOUDS] [SEED]    nasty ones, and as many near-degenerate ones; exit status 1 where any is
//   refused or wrong
#include <cstdio>
#include <cstdlib>

#include "test/fuzz/cloud_check.h"

using namespace fcl_stpbv;

int main(int argc, char** argv) {
  const int clouds = argc > 1 ? std::atoi(argv[1]) : 6000;
  const std::uint64_t seed = argc > 2 ? static_cast<std::uint64_t>(std::atoll(argv[2])) : 1;
  int bad = 0;
  for (const auto& [name, make] :
       {std::pair{"near-degenerate", fuzz::nearDegenerateCloud}, std::pair{"nasty", fuzz::nastyCloud}}) {
    test::Random random(seed), normals(seed);
    int complaints = 0;
    for (int i = 0; i < clouds; ++i) {
      const fuzz::CloudCase c = make(random);
      const std::string complaint = fuzz::complaintAbout(c, normals);
      if (complaint.empty()) continue;
      ++complaints;
      std::printf("%s %d: %zu points, R %.9g m: %s\n", name, i, c.points.size(), c.radii.R,
                  complaint.c_str());
    }
    std::printf("%s: of %d clouds %d are refused or wrong\n", name, clouds, complaints);
    std::fflush(stdout);
    bad += complaints;
  }
  return bad == 0 ? 0 : 1;
}
