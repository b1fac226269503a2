// A mesh as text: its lines, and the words and numbers in them as assimp reads them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fcl_stpbv::detail {

using MeshWords = std::vector<std::string_view>;

/// Takes the next word off a text; "" at the end of the text.
std::string_view takeWord(std::string_view& text);

MeshWords wordsOf(std::string_view text);

std::string inSmallLetters(std::string_view word);

/// Whether a word is a finite decimal that assimp reads correctly. assimp reads the digits before the decimal
/// point into a 64-bit integer, so more digits give 0 or an arbitrary number. It ignores decimals after the
/// 15th, which a large exponent could make significant.
bool readMeshNumber(std::string_view word, double& value);
bool isMeshNumber(std::string_view word);

/// For error messages: the form that a finite number must have for readMeshNumber().
constexpr const char* kNumberForm =
    "with a point for decimals, at most 18 digits before it, and no small one that a power enlarges";

/// Whether a word is a whole number from 0 that fits assimp's 32-bit integers.
bool readMeshIndex(std::string_view word, long& value);
bool isMeshIndex(std::string_view word);

/// Refuses a text with a NUL byte, because readers would take it for the text's end. @throws Error
/// "name:line: ..."
void refuseNul(std::string_view text, const std::string& name);

/// The lines of a text, each ended by a line feed, a carriage return or both.
class MeshLines {
 public:
  /// `text` and `name` must outlive this object.
  MeshLines(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

  /// Moves on to the next line; false at the end.
  bool next();

  /// The line without its end.
  std::string_view text() const { return text_; }
  /// The end of the line: "\n", "\r\n", "\r" or "".
  std::string_view end() const { return end_; }
  int line() const { return line_; }
  /// The text after this line.
  std::string_view rest() const { return rest_; }

  /// Refuses the file at this line; the message says what would work.
  [[noreturn]] void refuse(const std::string& message) const { refuse(line_, message); }
  [[noreturn]] void refuse(int line, const std::string& message) const;

  /// refuse() for a file that only the program that wrote it can correct.
  [[noreturn]] void damaged(const std::string& message) const { damaged(line_, message); }
  [[noreturn]] void damaged(int line, const std::string& message) const;

 private:
  std::string_view rest_, text_, end_;
  const std::string& name_;
  int line_ = 0;
};

}  // namespace fcl_stpbv::detail
