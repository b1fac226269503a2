// A damaged SRDF must not give a false "clear". For every damage to an element or attribute, either the file
// is refused, or it leaves out no pair that the original checks. A misspelt word is refused, gives a warning,
// or changes nothing.
#include <catch2/catch.hpp>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/robot/srdf.h"
#include "test/reference/source_folder.h"
#include "test/reference/volume_files.h"
#include "test/robot/xml_mutations.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;

namespace {

// Everything that the file decides: pairs left out, the named postures, the base.
std::string decisionsOf(const Srdf& srdf, const RobotModel& robot) {
  std::string text = srdf.baseJoint + " " + srdf.baseType;
  const SkipReasons reasons(&srdf);
  for (const LinkModel& a : robot.links)
    for (const LinkModel& b : robot.links)
      if (!reasons.of(a.name, b.name).empty()) text += "\n" + a.name + " " + b.name;
  for (const Srdf::State& state : srdf.states) {
    text += "\n" + state.name;
    for (const auto& [joint, values] : state.joints) {
      text += " " + joint;
      for (double value : values) text += " " + toDecimal(value);
    }
  }
  return text;
}

// Whether `mutated` leaves out a pair that `whole` checks.
bool hides(const Srdf& whole, const Srdf& mutated, const RobotModel& robot) {
  const SkipReasons before(&whole), after(&mutated);
  for (const LinkModel& a : robot.links)
    for (const LinkModel& b : robot.links)
      if (before.of(a.name, b.name).empty() && !after.of(a.name, b.name).empty()) return true;
  return false;
}

struct SrdfOutcome {
  int tried = 0, refused = 0, warned = 0;
};

SrdfOutcome mutateAll(const RobotModel& robot, const std::string& text) {
  const TemporaryFolder folder;
  const std::string path = folder / "mutated.srdf";
  const auto load = [&](const std::string& content) {
    put(path, content);
    return loadSrdf(path, robot);
  };
  const Srdf whole = load(text);
  REQUIRE(whole.warnings.empty());
  const std::string content = decisionsOf(whole, robot);
  SrdfOutcome outcome;
  for (int shift : {0, 4})  // each element is damaged in two ways
    forEachMutation(text, shift, 1, [&](const std::string& mutated, const Mutation& mutation) {
      ++outcome.tried;
      CAPTURE(mutation.what);
      try {
        const Srdf srdf = load(mutated);
        outcome.warned += srdf.warnings.empty() ? 0 : 1;
        // If an entry that enables a pair is gone, the pair is no longer checked, as the user may have
        // wished.
        const bool disabling = mutation.what.find("enable_collisions") == std::string::npos;
        if (disabling && hides(whole, srdf, robot)) FAIL_CHECK("a pair is left out that the file checks");
        if (mutation.misspelt && srdf.warnings.empty() && decisionsOf(srdf, robot) != content)
          FAIL_CHECK("a misspelt word has changed the file silently");
      } catch (const Error& error) {
        ++outcome.refused;
        if (std::string(error.what()).find("mutated.srdf") == std::string::npos) FAIL_CHECK(error.what());
      }
    });
  return outcome;
}

}  // namespace

TEST_CASE("an SRDF mutated in any element or attribute hides no pair") {
  std::vector<std::pair<std::string, std::string>> files{
      {sourceFolder() + "/data/hrp2_style/hrp2_style.urdf",
       sourceFolder() + "/data/hrp2_style/hrp2_style.srdf"}};
  const std::string shared = sharedFolder("robots");
  if (shared.empty())
    WARN("Panda skipped: no ../shared/robots");
  else
    files.emplace_back(shared + "/panda_description/urdf/panda.urdf",
                       shared + "/panda_description/srdf/panda.srdf");
  for (const auto& [urdf, srdf] : files) {
    CAPTURE(srdf);
    const SrdfOutcome outcome = mutateAll(loadUrdf(urdf), readText(srdf));
    CHECK(outcome.tried > 100);
    CHECK(outcome.refused + outcome.warned > outcome.tried / 4);
  }
}

TEST_CASE("every kind of SRDF entry is held by the mutations") {
  const std::string links =
      "<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/><joint name=\"j\" type=\"fixed\"><parent "
      "link=\"a\"/><child link=\"b\"/></joint><joint name=\"k\" type=\"continuous\"><parent "
      "link=\"b\"/><child "
      "link=\"c\"/></joint>";
  const RobotModel robot = parseUrdf("<robot name=\"r\">" + links + "</robot>", "r.urdf");
  const SrdfOutcome outcome = mutateAll(
      robot,
      "<robot name=\"r\"><group name=\"g\"><joint name=\"k\"/></group><group_state name=\"s\" "
      "group=\"g\"><joint name=\"k\" value=\"0.5\"/></group_state><virtual_joint name=\"v\" "
      "type=\"floating\" "
      "parent_frame=\"w\" child_link=\"a\"/><disable_default_collisions link=\"c\"/><enable_collisions "
      "link1=\"a\" link2=\"c\"/><disable_collisions link1=\"a\" link2=\"b\" reason=\"Adjacent\"/></robot>");
  CHECK(outcome.tried > 40);
}
