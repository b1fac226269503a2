// Reads a text file token by token and keeps track of the line, so that errors name the line and the field.
// Independent of the locale.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <iosfwd>
#include <string>
#include <string_view>

namespace fcl_stpbv::detail {

/// Largest size of a file, far more than any mesh or volume needs: 100 million vertices as text.
constexpr std::size_t kMostBytes = std::size_t(8) << 30;

/// The whole text of a file, of standard input for "-", or of a pipe up to where its writer closes it. A file
/// that does not end is refused past `mostBytes`.
/// @throws Error naming the file when it cannot be read, is larger, or is a device.
std::string readText(const std::string& path, std::size_t mostBytes = kMostBytes);

/// The rest of a stream; `name` stands for it in messages. @throws Error when reading fails, or as above.
std::string readText(std::istream& in, const std::string& name, std::size_t mostBytes = kMostBytes);

/// Appends the shortest decimal that reads back as exactly this double.
void appendNumber(std::string& text, double value);

/// The same for a message.
std::string toDecimal(double value);

/// Appends three numbers, separated by blanks.
void appendVector(std::string& text, const Eigen::Vector3d& v);

/// What a message says of a file's word: its first characters, those that cannot be printed as '?'.
std::string quoted(std::string_view word);

/// A number without the plus sign that some writers put before it and std::from_chars does not take.
std::string_view withoutPlus(std::string_view number);

/// Walks over whitespace-separated tokens. Every failure throws Error "name:line: got ..., expected ...".
class TextScanner {
 public:
  /// `text` must outlive the scanner.
  TextScanner(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {}

  /// The next token; `what` names the field for the message at the end of the file.
  std::string_view token(std::string_view what);
  /// A finite number.
  double number(std::string_view what);
  Eigen::Vector3d vector(std::string_view what);
  /// A whole number within [least, most].
  long integer(std::string_view what, long least, long most);
  /// The number of items that follow, each of which needs at least `bytesEach` bytes. A count that is too
  /// large for the rest of the file is an error, before any memory is allocated for it.
  int count(std::string_view what, int least, std::size_t bytesEach);
  /// A fixed word.
  void keyword(std::string_view word);
  /// Nothing but blanks may follow.
  void end();
  /// The rest of the current line, the line break taken.
  std::string_view restOfLine();

  bool atEnd();
  /// Bytes taken so far.
  std::size_t position() const { return at_; }
  int line() const { return line_; }
  const std::string& name() const { return name_; }
  /// Most significant digits seen in a number so far: how exact the file's writer was.
  int digits() const { return digits_; }

  /// Refuses the file at the line of the token read last.
  [[noreturn]] void fail(const std::string& message) const;

 private:
  void skipBlanks();

  std::string_view text_;
  std::string name_;
  std::size_t at_ = 0;
  int line_ = 1;
  int digits_ = 0;
};

}  // namespace fcl_stpbv::detail
