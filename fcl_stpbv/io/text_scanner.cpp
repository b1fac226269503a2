// A tokeniser that knows the current line, for error messages. Numbers use std::from_chars and std::to_chars,
// so the locale does not matter.
#include "fcl_stpbv/io/text_scanner.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <istream>
#include <limits>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv::detail {
namespace {

constexpr std::size_t kLongestQuote = 40;  // characters; keeps a message on one line

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f'; }

int significantDigits(std::string_view token) {
  int digits = 0;
  for (char c : token) {
    if (c == 'e' || c == 'E') break;
    if (c >= '1' && c <= '9') ++digits;
    if (c == '0' && digits > 0) ++digits;
  }
  return digits;
}

}  // namespace

std::string quoted(std::string_view word) {
  std::string text = "'";
  for (char c : word.substr(0, kLongestQuote)) text += (c >= ' ' && c <= '~') ? c : '?';
  return text + (word.size() > kLongestQuote ? "...'" : "'");
}

std::string whyNoFile(const std::string& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) == 0 || errno == ENOENT || errno == ENOTDIR) return "no such file";
  return "cannot be reached: " + std::string(std::strerror(errno)) +
         (errno == EACCES ? "; check the permissions of its folders" : "");
}

std::string readText(const std::string& path, std::size_t mostBytes) {
  std::error_code ignored;
  if (path.empty()) throw Error("the name of a file to read is empty; give one");
  const std::string file = path == "-" ? "/dev/stdin" : path;
  if (std::filesystem::is_directory(file, ignored)) throw Error(path + ": is a folder, expected a file");
  if (!std::filesystem::exists(file, ignored)) throw Error(path + ": " + whyNoFile(file));
  const bool terminal = file == "/dev/stdin" && ::isatty(STDIN_FILENO) != 0;
  if (std::filesystem::is_block_file(file, ignored) ||
      (std::filesystem::is_character_file(file, ignored) && !terminal))
    throw Error(path + ": is a device, expected a file or a pipe");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(path + ": cannot be opened for reading; check its permissions");
  return readText(in, path, mostBytes);
}

std::string readText(std::istream& in, const std::string& name, std::size_t mostBytes) {
  constexpr std::size_t kPiece = 1 << 16;
  std::string text;
  for (std::size_t got = kPiece; got == kPiece;) {
    const std::size_t before = text.size();
    text.resize(before + kPiece);
    in.read(text.data() + before, kPiece);
    got = static_cast<std::size_t>(in.gcount());
    text.resize(before + got);
    if (text.size() > mostBytes)
      throw Error(name + ": larger than the " + std::to_string(mostBytes >> 20) + " MB that are read");
  }
  if (in.bad()) throw Error(name + ": reading failed");
  return text;
}

void appendNumber(std::string& text, double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  text.append(buffer, result.ptr);
}

std::string toDecimal(double value) {
  std::string text;
  appendNumber(text, value);
  return text;
}

void appendVector(std::string& text, const Eigen::Vector3d& v) {
  appendNumber(text, v.x());
  text += ' ';
  appendNumber(text, v.y());
  text += ' ';
  appendNumber(text, v.z());
}

void TextScanner::fail(const std::string& message) const {
  throw Error(name_ + ":" + std::to_string(line_) + ": " + message);
}

void TextScanner::skipBlanks() {
  for (; at_ < text_.size() && isBlank(text_[at_]); ++at_) line_ += text_[at_] == '\n';
}

bool TextScanner::atEnd() {
  skipBlanks();
  return at_ == text_.size();
}

std::string_view withoutPlus(std::string_view number) {
  const bool plus = number.size() > 1 && number[0] == '+' && number[1] != '-';  // "+-1" is no number
  return number.substr(plus ? 1 : 0);
}

bool readDecimal(std::string_view word, double& value) {
  const std::string_view digits = withoutPlus(word);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return error == std::errc() && end == digits.data() + digits.size();
}

std::string_view TextScanner::token(std::string_view what) {
  if (atEnd()) fail("the file ends here, expected " + std::string(what));
  const std::size_t start = at_;
  while (at_ < text_.size() && !isBlank(text_[at_])) ++at_;
  return text_.substr(start, at_ - start);
}

double TextScanner::number(std::string_view what) {
  const std::string_view word = token(what);
  double value = 0;
  if (!readDecimal(word, value) || !std::isfinite(value))
    fail("got " + quoted(word) + ", expected " + std::string(what) + ", a finite number");
  digits_ = std::max(digits_, significantDigits(withoutPlus(word)));
  return value;
}

Eigen::Vector3d TextScanner::vector(std::string_view what) {
  const double x = number(what);
  const double y = number(what);
  const double z = number(what);
  return {x, y, z};
}

long TextScanner::integer(std::string_view what, long least, long most) {
  const std::string_view word = token(what);
  long value = 0;
  const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
  if (result.ec != std::errc() || result.ptr != word.data() + word.size() || value < least || value > most) {
    fail("got " + quoted(word) + ", expected " + std::string(what) + ", a whole number from " +
         std::to_string(least) + " to " + std::to_string(most));
  }
  return value;
}

int TextScanner::count(std::string_view what, int least, std::size_t bytesEach) {
  const long value = integer(what, least, std::numeric_limits<int>::max());
  // The last item needs no blank after it.
  const std::size_t fits = (text_.size() - at_ + 1) / bytesEach;
  if (static_cast<std::size_t>(value) > fits) {
    fail("says " + std::to_string(value) + " as " + std::string(what) +
         ", but the rest of the file can contain " + std::to_string(fits) + " at most");
  }
  return static_cast<int>(value);
}

void TextScanner::keyword(std::string_view word) {
  const std::string expected = "the word '" + std::string(word) + "'";
  const std::string_view got = token(expected);
  if (got != word) fail("got " + quoted(got) + ", expected " + expected);
}

void TextScanner::end() {
  if (atEnd()) return;
  fail("got " + quoted(token("")) + ", expected the end of the file");
}

std::string_view TextScanner::restOfLine() {
  const std::size_t start = at_;
  while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  const std::string_view rest = text_.substr(start, at_ - start);
  if (at_ < text_.size()) {
    ++at_;
    ++line_;
  }
  return rest;
}

}  // namespace fcl_stpbv::detail
