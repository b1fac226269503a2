// A pair list from the cache is believed only if its numbers can be one.
#include <catch2/catch.hpp>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/report/kept_list.h"
#include "test/reference/robots.h"
#include "test/reference/volume_files.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
namespace fs = std::filesystem;

namespace {

// The entry's numbers, of which one is another; its digest is right again.
std::string changed(const std::string& entry, const fs::path& file, std::size_t line,
                    const std::string& number) {
  std::istringstream in(entry.substr(entry.find('\n') + 1));
  std::string text = "\n", next;
  for (std::size_t i = 0; std::getline(in, next); ++i) text += (i == line ? number : next) + "\n";
  return digestOf(file.stem().string() + text) + text;
}

bool isSame(const std::vector<PairEntry>& a, const std::vector<PairEntry>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const PairEntry& x, const PairEntry& y) {
    return x.link1 == y.link1 && x.link2 == y.link2 && x.obstacle == y.obstacle && x.reason == y.reason &&
           x.samples == y.samples && x.minDistance == y.minDistance && x.closest == y.closest;
  });
}

PairListOptions fewSamples() {
  PairListOptions options;
  options.samples = 60;
  options.descents = options.randomDescents = 0;
  options.proofBoxes = 0;
  return options;
}

}  // namespace

TEST_CASE("a list is kept apart from that of an SRDF that leaves out other pairs, or none") {
  const Problem p = problem(robots()[0]);
  REQUIRE(p.geometry->bodies.size() > 2);
  const auto name = [&](std::size_t body) {
    return p.model->links[detail::at(p.geometry->bodies[body].link)].name;
  };
  const auto index = [&](std::size_t body) { return std::to_string(p.geometry->bodies[body].link); };
  Srdf never, user, oneReason;
  never.disabled = {{name(0), name(1), "Never"}};
  user.disabled = {{name(0), name(1), "Never"}, {name(0), name(2), "User"}};
  oneReason.disabled = {{name(0), name(1), "Never\n" + index(0) + " " + index(2) + " User"}};
  const Srdf noPair;
  const PairListOptions options = fewSamples();
  for (const auto& [first, second] : std::vector<std::pair<const Srdf*, const Srdf*>>{
           {nullptr, &noPair}, {&noPair, nullptr}, {&noPair, &never}, {&never, &user}, {&user, &oneReason}}) {
    const TemporaryFolder folder;
    VolumeCache cache(folder / "a");
    report::keptPairList(p.kinematics, p.geometry, first, options, cache);
    CHECK(isSame(report::keptPairList(p.kinematics, p.geometry, second, options, cache),
                 pairList(p.kinematics, p.geometry, second, options)));
  }
}

TEST_CASE("a pair list of numbers that cannot be one is searched anew") {
  const Problem p = problem(robots()[0]);
  const PairListOptions options = fewSamples();
  const TemporaryFolder folder;
  const auto kept = [&] {
    VolumeCache cache(folder / "a");
    return report::keptPairList(p.kinematics, p.geometry, nullptr, options, cache);
  };
  const std::vector<PairEntry> searched = kept();
  REQUIRE(searched.size() > 3);
  const fs::path file = fs::directory_iterator(folder / "a")->path();
  const std::string entry = contentOf(file.string());
  CHECK(isSame(kept(), searched));

  // The seventh number of an entry is its least distance: it is taken from the file.
  put(file.string(), changed(entry, file, 6, "123"));
  CHECK(kept()[0].minDistance == 123);

  const std::string links = std::to_string(p.model->links.size());
  const std::vector<std::vector<std::string>> wrong{{"-1", links, "1e300", "0.5"},
                                                    {"-1", links, "1e300", "0.5"},
                                                    {"1", "2", "-1"},  // links, obstacle
                                                    {"-1", "9", "1e300", "0.5"},
                                                    {"-1", "1e300", "0.5"},
                                                    {"-1", "1e300"},  // reason, counts
                                                    {},
                                                    {"2", "-1"},
                                                    {},                // by descent
                                                    {"-1", "1e300"}};  // boxes
  for (std::size_t line = 0; line < wrong.size(); ++line)
    for (const std::string& number : wrong[line]) {
      put(file.string(), changed(entry, file, line, number));
      CAPTURE(line, number);
      CHECK(isSame(kept(), searched));
    }
}
