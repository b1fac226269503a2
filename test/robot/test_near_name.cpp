// The known name that is suggested for a misspelt one.
#include <catch2/catch.hpp>

#include "fcl_stpbv/robot/near_name.h"

using namespace fcl_stpbv::detail;

TEST_CASE("a misspelt name is near the one that fewest letters have to be changed for") {
  const std::vector<std::string> known{"base", "ELBOW_JOINT", "elbow_link", "ee", "q"};
  CHECK(nearName("elbow_lnk", known) == "elbow_link");
  CHECK(nearName("Elbow_Joint", known) == "ELBOW_JOINT");  // upper and lower case are the same
  CHECK(nearName("link", known) == "elbow_link");          // it is a part of the name
  CHECK(nearName("JOINT", known) == "ELBOW_JOINT");        // it is a part of the name
  CHECK(nearName("panda_base", known) == "base");          // the name is a part of it
  CHECK(nearName("left/elbow_joint", known) == "ELBOW_JOINT");
  CHECK(nearName("knee", known).empty());  // contains "ee" by chance
  CHECK(nearName("r", known).empty());     // one letter instead of another is another name
  CHECK(nearName("Q", known) == "q");
  CHECK(nearName("", known).empty());
  CHECK(nearName("base", {"", std::string(200, 'b')}).empty());
  CHECK(didYouMean("bse", known) == "; did you mean 'base'?");
  CHECK(didYouMean("shoulder", known).empty());
}

TEST_CASE("only the first few of many misspelt names are looked for") {
  FirstProposals proposals;
  int asked = 0;
  const auto known = [&] { return ++asked, std::vector<std::string>{"base"}; };
  CHECK(proposals.of("bse", known) == "; did you mean 'base'?");
  for (int i = 0; i < 1000; ++i) proposals.near("bas", known);
  CHECK(asked == 5);
  CHECK(proposals.of("bse", known).empty());
}
