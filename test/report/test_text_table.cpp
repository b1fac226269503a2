// Tables in texts: the columns are aligned for names in any script.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/report/text_table.h"
#include "fcl_stpbv/text_cells.h"

using namespace fcl_stpbv;

namespace {

constexpr const char* kHand = "\u53f3\u8155";             // two wide letters
constexpr const char* kBody = "Ko\u0308rper";             // one letter is two characters
constexpr const char* kArm = "\u0440\u0443\u043a\u0430";  // two bytes per letter

}  // namespace

TEST_CASE("A text takes as many cells as a terminal shows it in") {
  CHECK(detail::cellsOf("") == 0);
  CHECK(detail::cellsOf("link 1") == 6);
  CHECK(detail::cellsOf(kHand) == 4);
  CHECK(detail::cellsOf(kBody) == 6);
  CHECK(detail::cellsOf(kArm) == 4);
  CHECK(detail::cellsOf("\xff\xe5\x8f") == 3);  // no UTF-8
}

TEST_CASE("A text is cut between characters, and what cannot be shown becomes a question mark") {
  CHECK(detail::fittedInto(9, "link") == "link");
  CHECK(detail::fittedInto(3, "link") == "lin");
  CHECK(detail::fittedInto(3, kHand) == "\u53f3");
  CHECK(detail::fittedInto(2, kBody) == "Ko\u0308");
  CHECK(detail::fittedInto(9, "a\nb\xff") == "a?b?");
  CHECK(detail::fittedInto(0, "link").empty());
}

TEST_CASE("The columns of a table are as wide as their contents") {
  report::TextTable table("lrl");
  table.add({"name", "[mm]", "why"});
  table.add({kHand, "1.500", ""});
  table.add({kBody, "", "far"});
  table.add({kArm, "-12.250", "near"});
  CHECK(table.text() == "name       [mm]  why\n" + (kHand + std::string("      1.500\n")) + kBody +
                            "           far\n" + kArm + "    -12.250  near\n");
  report::TextTable indented("lr");
  indented.add({"a", "1"});
  CHECK(indented.text(2) == "  a  1\n");
  CHECK(report::TextTable("l").text().empty());
}

TEST_CASE("A number that shows as zero has no minus sign") {
  CHECK(detail::fixed(-1e-9, 6) == "0.000000");
  CHECK(detail::fixed(-0.0, 0) == "0");
  CHECK(detail::fixed(-0.5, 3) == "-0.500");
  CHECK(detail::fixed(-HUGE_VAL, 3) == "-inf");
  CHECK(detail::signedFixed(-1e-9, 3) == "+0.000");
  CHECK(detail::signedFixed(0.5, 1) == "+0.5");
  CHECK(detail::signedFixed(-0.5, 1) == "-0.5");
}
