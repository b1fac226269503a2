// Clouds of a real humanoid: the convex hulls published with JVRC-1.
#include <catch2/catch.hpp>
#include <filesystem>

#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/stp_bv.h"
#include "test/reference/source_folder.h"

using namespace fcl_stpbv;
namespace fs = std::filesystem;

TEST_CASE("All 35 links of JVRC-1 build and verify at R = 10 m and just above their smallest R") {
  const fs::path folder = fs::path(test::sourceFolder()) / "../shared/robots/jvrc_description/convex/jvrc1";
  if (!fs::exists(folder)) {
    WARN("skipped: " << folder << " is not there");
    return;
  }
  int links = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::vector<Eigen::Vector3d> points = loadQhullPoints(entry.path().string());
    const double smallest = StpBv::smallestR(points, 0.01);
    for (const double R : {10.0, smallest * 1.001, smallest * (1 + 1e-9)}) {
      const Verification check = verify(*StpBv::build(points, {0.01, R}), points);
      INFO(entry.path().filename() << " at R = " << R << ": " << check.message);
      CHECK(check.ok);
    }
    ++links;
  }
  CHECK(links == 35);
}
