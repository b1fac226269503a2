// Constant lists of words that need no initialisation at run time. So robots can be read during static
// initialisation.
#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string_view>

namespace fcl_stpbv::detail {

/// A list of words. Outside of functions it is declared `constexpr`.
class Words {
 public:
  constexpr Words(std::initializer_list<std::string_view> words) {
    for (const std::string_view word : words) word_[count_++] = word;
  }
  constexpr const std::string_view* begin() const { return word_.data(); }
  constexpr const std::string_view* end() const { return word_.data() + count_; }

 private:
  static constexpr std::size_t kMost = 24;  // a longer list does not compile
  std::array<std::string_view, kMost> word_{};
  std::size_t count_ = 0;
};

inline bool holds(const Words& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace fcl_stpbv::detail
