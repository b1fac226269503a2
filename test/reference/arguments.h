// Command lines of programs that take a few plain numbers. Anything else ends the program with status 2,
// because a run that tested nothing must differ from one that found nothing.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace fcl_stpbv::test {

class Arguments {
 public:
  /// `usage` names the arguments, such as "[QUERIES [SEED]]". `most` is the largest number of arguments.
  Arguments(int argc, char** argv, std::string usage, int most)
      : count_(argc - 1), argv_(argv), usage_(std::string(argv[0]) + " " + std::move(usage)) {
    std::atexit([] {  // results that could not be written are a failure, whatever they are
      if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
      std::perror("standard output cannot be written");
      std::_Exit(2);
    });
    if (count_ == 1 && (std::string_view(argv[1]) == "--help" || std::string_view(argv[1]) == "-h")) {
      std::printf("%s\n", usage_.c_str());
      std::exit(0);
    }
    if (count_ > most) refuse();
  }

  /// The argument `i`, counted from 1, or `standard` if there are fewer.
  template <class Number>
  Number number(int i, Number standard, Number least = 1) const {
    if (i > count_) return standard;
    // A limit, because no soak runs for thirty years.
    constexpr Number kMost =
        std::is_floating_point_v<Number> ? Number(1e9) : std::numeric_limits<Number>::max();
    const std::string_view word = argv_[i];
    Number value{};
    const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
    if (result.ec != std::errc() || result.ptr != word.data() + word.size() ||
        !(value >= least && value <= kMost))
      refuse();
    return value;
  }
  std::string text(int i, const std::string& standard) const {
    if (i > count_) return standard;
    if (argv_[i][0] == '-') refuse();
    return argv_[i];
  }
  /// The argument `i`, which must be one of these words; the first of them if there are fewer arguments.
  std::string oneOf(int i, const std::vector<std::string>& words) const {
    const std::string word = text(i, words[0]);
    if (std::find(words.begin(), words.end(), word) == words.end()) refuse();
    return word;
  }
  /// The arguments from `i` on, at least `least` of them.
  std::vector<std::string> texts(int i, int least = 0) const {
    if (count_ - i + 1 < least) refuse();
    std::vector<std::string> all;
    for (; i <= count_; ++i) all.push_back(text(i, ""));
    return all;
  }

 private:
  [[noreturn]] void refuse() const {
    std::fprintf(stderr, "usage: %s\n", usage_.c_str());
    std::exit(2);
  }

  int count_;
  char** argv_;
  std::string usage_;
};

}  // namespace fcl_stpbv::test
