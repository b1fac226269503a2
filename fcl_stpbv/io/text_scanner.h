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

/// Why a path leads to no file, for messages: there is none, or it cannot be reached.
std::string whyNoFile(const std::string& path);

/// The whole text of a file, of standard input for "-", or of a pipe until its writer closes it. A text of
/// more than `mostBytes` is refused, and so is a file without an end.
/// @throws Error naming the file if it cannot be read, is larger, or is a device.
std::string readText(const std::string& path, std::size_t mostBytes = kMostBytes);

/// The rest of a stream; `name` stands for it in messages. @throws Error if reading fails, or as above.
std::string readText(std::istream& in, const std::string& name, std::size_t mostBytes = kMostBytes);

/// Appends the shortest decimal that reads back as exactly this double.
void appendNumber(std::string& text, double value);

/// The shortest decimal that reads back as exactly this double, for messages.
std::string toDecimal(double value);

/// Appends three numbers, separated by blanks.
void appendVector(std::string& text, const Eigen::Vector3d& v);

/// A word of a file as messages show it: its first characters, with '?' for those that cannot be printed.
std::string quoted(std::string_view word);

/// A number without its plus sign. Some writers put one before a number, but std::from_chars does not accept
/// it.
std::string_view withoutPlus(std::string_view number);

/// Reads a word that is a decimal number as a whole; it may be infinite or NaN. @returns whether it is one.
bool readDecimal(std::string_view word, double& value);

/// Walks over whitespace-separated tokens. Every failure throws Error "name:line: got ..., expected ...".
class TextScanner {
 public:
  /// `text` must outlive the scanner.
  TextScanner(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {}

  /// The next token. `what` names the expected field in the message if the file ends.
  std::string_view token(std::string_view what);
  /// A finite number.
  double number(std::string_view what);
  Eigen::Vector3d vector(std::string_view what);
  /// A whole number within [least, most].
  long integer(std::string_view what, long least, long most);
  /// The number of items that follow, each of which needs at least `bytesEach` bytes. A count that is too
  /// large for the rest of the file is an error, before any memory is allocated for it.
  int count(std::string_view what, int least, std::size_t bytesEach);
  /// Fails unless the next token is this word.
  void keyword(std::string_view word);
  /// Fails if anything but blanks follows.
  void end();
  /// The rest of the current line. The line break is skipped.
  std::string_view restOfLine();

  bool atEnd();
  /// Number of bytes read so far.
  std::size_t position() const { return at_; }
  int line() const { return line_; }
  const std::string& name() const { return name_; }
  /// Largest number of significant digits of a number so far: how exact the file's writer was.
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
