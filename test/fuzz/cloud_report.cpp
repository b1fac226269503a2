// How the builder does on nasty clouds, the figures of docs/stability.md: cloud_report [CLOUDS] [SEED]
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/volume/verify.h"
#include "test/fuzz/clouds.h"
#include "test/reference/arguments.h"

using namespace fcl_stpbv;

int main(int argc, char** argv) {
  const test::Arguments arguments(argc, argv, "[CLOUDS [SEED]]", 2);
  const int clouds = arguments.number(1, 6000);
  test::Random random(arguments.number(2, std::uint64_t{1}));
  int refused = 0, off = 0;
  for (int i = 0; i < clouds; ++i) {
    const fuzz::CloudCase c = fuzz::nastyCloud(random);
    try {
      const StpBv::Ptr volume = StpBv::build(c.points, c.radii);
      const Verification found = verify(*volume, c.points, c.radii.r);
      if (found.ok) continue;
      ++off;
      std::printf("%d: size %.3g m, R %.3g sizes: %s\n", i, volume->enclosingRadius(),
                  c.radii.R / volume->enclosingRadius(), found.message.c_str());
    } catch (const Error& e) {
      ++refused;
      std::printf("%d: refused: %s\n", i, e.what());
    }
  }
  std::printf("of %d clouds %d are refused, %d build and fail verify()\n", clouds, refused, off);
  return 0;
}
