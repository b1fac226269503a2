// Asks one question about two types of geometry with FCL and with the library, at many poses. It does so in
// child processes, because FCL crashes or hangs for some. Each kind of difference is one letter.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "test/adapter/parity/types.h"

namespace fcl_stpbv::parity {

constexpr const char* kOursIsWrong = "WRONG HERE";

/// The findings at the tested poses. Letters are FCL's faults. If the library has a fault, the test fails.
class Findings {
 public:
  /// Notes the letter if `fault` is true.
  void theirs(char letter, bool fault);
  /// Notes a fault of the library, with what is wrong.
  void ours(const char* wrong, bool fault);
  void unanswered();             ///< the library has no answer for these types
  void say(const char* answer);  ///< gives the answer in words, instead of letters

  std::string text() const;      ///< the letters of a table's cell
  std::string ourFault() const;  ///< "" for none

 private:
  bool letter_[26] = {};
  bool unanswered_ = false;
  char wrong_[120] = "", said_[120] = "";
};

/// The poses with number `i` of two geometries. Odd ones are near or overlapping, even ones mostly apart.
struct Placement {
  Eigen::Isometry3d a, b;
};
Placement placementOf(test::Random& random, int i);

/// Asks about the placement or motion `i`. The generator starts in the same state each time.
using Question = std::function<void(const Type&, const Type&, int i, test::Random&, Findings&)>;

using Pairs = std::vector<std::pair<const Type*, const Type*>>;

/// The cell of each pair of types. The question is asked `count` times in a child process, which is started
/// again after each time that crashes or takes a second of processor time. For a fault of the library the
/// cell is `kOursIsWrong`, and the fault is named on standard error.
std::vector<std::string> cellsOf(const Pairs& pairs, const Question& question, int count, int seed = 0);

/// A Markdown table over all types, with the first geometry in rows and the second in columns.
std::string tableOf(const std::vector<Type>& types, const Question& question, int count, int seed);

Question distanceQuestion(bool isSigned);
Question collideQuestion();
Question motionQuestion(bool conservative);

/// The table of the seven managers, six entries each.
std::string managerTable();
/// The table of the fields of requests and results, one by one.
std::string fieldTable();

}  // namespace fcl_stpbv::parity
