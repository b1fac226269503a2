// Splits a mesh in text form into lines and words, and detects numbers that assimp would read wrongly.
#include "fcl_stpbv/mesh/mesh_lines.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"

namespace fcl_stpbv::detail {
namespace {

constexpr std::size_t kMostDigits = 18;
constexpr std::size_t kMostDecimals = 15;
constexpr long kMostIndex = 2147483647;

// Whether a number has a power of ten that makes the decimals after the 15th more than a billionth of it.
bool losesDecimals(std::string_view number) {
  const std::size_t power = std::min(number.find_first_of("eE"), number.size());
  const std::size_t point = std::min(number.find('.'), power);
  if (power - point <= 1 + kMostDecimals) return false;
  constexpr double kLeast = 1e-6;  // a billion times the last decimal that counts
  double digits = 0, ten = 0;
  std::from_chars(number.data(), number.data() + power, digits);
  const std::string_view exponent = withoutPlus(number.substr(std::min(power + 1, number.size())));
  std::from_chars(exponent.data(), exponent.data() + exponent.size(), ten);
  return ten > 0 && digits != 0 && std::abs(digits) < kLeast;
}

bool isBreak(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

}  // namespace

std::string_view takeWord(std::string_view& text) {
  std::size_t start = 0;
  while (start < text.size() && isBreak(text[start])) ++start;
  std::size_t end = start;
  while (end < text.size() && !isBreak(text[end])) ++end;
  const std::string_view word = text.substr(start, end - start);
  text.remove_prefix(end);
  return word;
}

MeshWords wordsOf(std::string_view text) {
  MeshWords words;
  for (std::string_view word = takeWord(text); !word.empty(); word = takeWord(text)) words.push_back(word);
  return words;
}

std::string inSmallLetters(std::string_view word) {
  std::string small(word);
  std::transform(small.begin(), small.end(), small.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return small;
}

bool readMeshNumber(std::string_view word, double& value) {
  if (!readDecimal(word, value) || !std::isfinite(value)) return false;
  word = withoutPlus(word);
  if (losesDecimals(word)) return false;
  word.remove_prefix(std::min(word.find_first_not_of("-0"), word.size()));
  return std::min(word.find_first_not_of("0123456789"), word.size()) <= kMostDigits;
}

bool isMeshNumber(std::string_view word) {
  double value = 0;
  return readMeshNumber(word, value);
}

bool readMeshIndex(std::string_view word, long& value) {
  const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
  return result.ec == std::errc() && result.ptr == word.data() + word.size() && value >= 0 &&
         value <= kMostIndex;
}

bool isMeshIndex(std::string_view word) {
  long value = 0;
  return readMeshIndex(word, value);
}

void refuseNul(std::string_view text, const std::string& name) {
  const std::size_t at = text.find('\0');
  if (at == std::string_view::npos) return;
  MeshLines lines(text, name);
  while (lines.next() && text.size() - lines.rest().size() <= at) {
  }
  lines.damaged("a NUL byte in a text");
}

bool MeshLines::next() {
  if (rest_.empty()) return false;
  const std::size_t length = std::min(rest_.find_first_of("\r\n"), rest_.size());
  text_ = rest_.substr(0, length);
  end_ = rest_.substr(length, rest_.substr(length, 2) == "\r\n" ? 2 : 1);
  rest_.remove_prefix(length + end_.size());
  ++line_;
  return true;
}

void MeshLines::refuse(int line, const std::string& message) const {
  throw Error(name_ + ":" + std::to_string(line) + ": " + message);
}

void MeshLines::damaged(int line, const std::string& message) const {
  refuse(line, message + "; the file is damaged, export it again");
}

}  // namespace fcl_stpbv::detail
