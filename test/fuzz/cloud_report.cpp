// Counts how the builder, verify() and the measures handle difficult clouds. The figures of
// docs/stability.md:
//   cloud_report [CLOUDS] [SEED]    CLOUDS difficult ones, and as many near-degenerate ones; exit status 1 if
//   any is refused or wrong
#include <cstdio>
#include <cstdlib>

#include "test/fuzz/cloud_check.h"
#include "test/reference/arguments.h"

using namespace fcl_stpbv;

int main(int argc, char** argv) {
  const test::Arguments arguments(argc, argv, "[CLOUDS [SEED]]", 2);
  const int clouds = arguments.number(1, 6000);
  const auto seed = arguments.number(2, std::uint64_t{1});
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
