// Makes docs/fcl_differences.md: every documented entry of FCL, tested with FCL and with the library.
//   fcl_parity                 prints the page
// fcl_parity --check PAGE    fails if the page differs
//   fcl_parity --seed N        the same about other poses and motions; fails where the library is wrong, as
//   all do
#include <cstdint>
#include <cstdio>
#include <string>

#include "fcl_stpbv/io/text_scanner.h"
#include "test/adapter/parity/questions.h"
#include "tools/program.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::parity;

namespace {

std::string page(int seed) {
  const std::vector<Type> types = allTypes();
  const std::vector<Type> shapes(types.begin(), types.begin() + kShapes);
  std::string text = R"(# Where FCL 0.7 and this library differ

Made by `fcl_parity`, which asks FCL and the library the same and takes a third opinion: convex pieces in long double, which share no
code with either (`test/adapter/parity`). The test of that name fails where the library is wrong, or where this page is not what it finds.
How far off FCL is where it is off: [fcl_accuracy.md](fcl_accuracy.md).

<!-- not run: the test fcl_parity runs it -->

    fcl_parity

A cell is one pair of types, the row's the first one. `.`: both are right. A letter is a fault of FCL's, by the third opinion:

| letter | FCL |
|---|---|
| `x` | ends the process, throws, or takes more than a second |
| `n` | has no function, and says so on the standard error output only: the result stays as it was |
| `s` | says apart where they overlap, or the other way round |
| `d` | distance off by more than 1e-6 m, depth by more than 1e-4 m |
| `p` | nearest points off by more than 1 mm: not on their bodies, or not the distance apart |
| `b` | `b1`, `b2` are not the nearest triangle or cell; of contacts: not those that meet |
| `o` | `o1`, `o2` are swapped, and with them all that belongs to one of them |
| `m` | misses a contact |
| `u` | makes one up |
| `v` | moving apart along the normal by the depth does not separate |
| `q` | the place of a contact is farther than the depth from one of the two |
| `l` | the contact comes later than `toc_err` allows |

`-` is the library without an answer: two of half space and plane. It says -1 for a distance, a contact for `collide`.

)";
  text += "## `fcl::distance`\n\nThe default request with nearest points, six poses each.\n\n" +
          tableOf(types, distanceQuestion(false), 6, seed) +
          "\nWith `enable_signed_distance`, which also asks for depths, of shapes:\n\n" +
          tableOf(shapes, distanceQuestion(true), 6, seed);
  text +=
      "\n## `fcl::collide`\n\nAll contacts, six poses each.\n\n" + tableOf(types, collideQuestion(), 6, seed);
  text +=
      "\n## `fcl::continuousCollide`\n\nFour motions each, `InterpMotion` with its point given, by ten "
      "samples (`CCDC_NAIVE`, the "
      "default):\n\n" +
      tableOf(types, motionQuestion(false), 4, seed) + "\nBy `CCDC_CONSERVATIVE_ADVANCEMENT`:\n\n" +
      tableOf(types, motionQuestion(true), 4, seed);
  text +=
      "\nTwo motions cannot be asked about, as FCL leaves their memory uninitialised: between two poses by "
      "`CCDM_LINEAR`, whose "
      "point that moves\nstraight is unset, and by `CCDM_SPLINE`. Here the first one moves the origin "
      "straight, and the "
      "second one is refused: -1 and a contact.\n";
  text +=
      "\n## Managers\n\nFifty balls and boxes, scattered and crowded: `collide` and `distance` of a manager "
      "with itself, with an "
      "object, with another manager; FCL's\ncallbacks and the library's, which are told of the same pairs. "
      "`m`: some pairs in contact are left out, "
      "`t`: they come twice, whatever the callback; with FCL's own\ncallback `d`: the least distance is "
      "wrong, "
      "`p`: not that of the deepest pair, as `fcl::distance` knows no depths.\n\n" +
      managerTable();
  text += "\n## Fields\n\n" + fieldTable();
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  tools::Program program(
      "Asks FCL and the library about every pair of types, and prints docs/fcl_differences.md.",
      "fcl_parity");
  std::string checked;
  std::uint64_t seed = 0;
  tools::Option check = program.option("--check", checked, "Fail if this page says otherwise").type("PAGE");
  program.option("--seed", seed, "The same about other poses and motions").whole(0, 1000000).excludes(check);
  return program.run(argc, argv, [&] {
    const std::string text = page(static_cast<int>(seed));
    if (checked.empty()) std::printf("%s", text.c_str());
    if (text.find(kOursIsWrong) != std::string::npos) return 1;
    if (checked.empty() || detail::readText(checked) == text) return 0;
    std::fprintf(stderr, "%s is not what fcl_parity finds: fcl_parity > %s\n", checked.c_str(),
                 checked.c_str());
    return 1;
  });
}
