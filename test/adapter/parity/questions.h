// One question about two types of geometry, asked of FCL and of the library at many poses in child processes,
// as FCL ends or hangs some; what differs is one letter a kind of difference.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "test/adapter/parity/types.h"

namespace fcl_stpbv::parity {

constexpr const char* kOursIsWrong = "WRONG HERE";

/// What came out at the poses asked about. Letters are FCL's faults; the library has none or the test fails.
class Findings {
 public:
  /// Notes the letter where `fault` holds.
  void theirs(char letter, bool fault);
  /// The library's own fault, with what is wrong.
  void ours(const char* wrong, bool fault);
  void unanswered();             ///< the library has no answer for these types
  void say(const char* answer);  ///< in words, instead of letters

  std::string text() const;      ///< the letters of a table's cell
  std::string ourFault() const;  ///< "" for none

 private:
  bool letter_[26] = {};
  bool unanswered_ = false;
  char wrong_[120] = "", said_[120] = "";
};

/// Poses `i` of two geometries. Odd ones are near or overlapping, even ones mostly apart.
struct Placement {
  Eigen::Isometry3d a, b;
};
Placement placementOf(test::Random& random, int i);

/// Asks about the placement or motion `i`; the generator is the same whenever it is asked.
using Question = std::function<void(const Type&, const Type&, int i, test::Random&, Findings&)>;

using Pairs = std::vector<std::pair<const Type*, const Type*>>;

/// The cell of each pair of types: `count` times asked in a child process, which is started anew after each
/// time that ends it or takes a second of processor time. `kOursIsWrong` for a fault of the library, which is
/// named on the standard error output.
std::vector<std::string> cellsOf(const Pairs& pairs, const Question& question, int count, int seed = 0);

/// A Markdown table over all types, rows the first geometry and columns the second.
std::string tableOf(const std::vector<Type>& types, const Question& question, int count, int seed);

Question distanceQuestion(bool isSigned);
Question collideQuestion();
Question motionQuestion(bool conservative);

/// The seven managers, six entries each.
std::string managerTable();
/// The fields of requests and results, one by one.
std::string fieldTable();

}  // namespace fcl_stpbv::parity
