// What the main of every program does: options in, help and version out, status 2 for a command line that is
// wrong, for an input that cannot be used, and for output that could not be written. CLI11 reads the command
// line. Only program.cpp includes it, as a file that does takes ten seconds to compile.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace fcl_stpbv::tools {

/// An option of a Program, to say more about it: `program.option("-n", n, "Runs").whole(1).shown()`.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option required();
  /// What the help calls the value, where it is no number and none of some words.
  Option type(const std::string& name);
  /// Each time that it is given it takes one value; all count.
  Option repeated();
  /// The help shows the value that holds where the option is not given.
  Option shown();
  /// Finite and from `least` to `most`, without `least` itself unless `orEqual`; or the word `orWord`.
  Option number(double least, double most, bool orEqual = true, const std::string& orWord = "");
  Option whole(std::uint64_t least = 0, std::uint64_t most = std::numeric_limits<std::uint64_t>::max());
  Option oneOf(const std::vector<std::string>& words);
  Option existingFile();
  /// Only together with `other`.
  Option needs(Option other);
  /// Never together with `other`.
  Option excludes(Option other);

 private:
  CLI::Option* option_;
};

/// One message to standard error, after the program's name. Control characters, which names in it may have,
/// would move the cursor or colour what follows: they become '?'.
void tell(const std::string& program, std::string message);

class Program {
 public:
  Program(const std::string& description, const std::string& name);
  ~Program();

  /// Below the options in the help. A line that begins with a space stays one where the terminal has room for
  /// it; others are wrapped anew.
  void footer(const std::string& text);
  /// `names` as in "-o,--output", or without dashes for a place on the command line. `value` is set when
  /// run() reads the command line, and keeps what it has where the option is not given. An empty value is
  /// refused: it comes from a shell variable that is not set. program.cpp lists the types that there are.
  template <class Value>
  Option option(const std::string& names, Value& value, const std::string& help);
  /// An option without a value; "!--no-x" sets `value` to false.
  Option flag(const std::string& names, bool& value, const std::string& help);

  /// Reads the command line and does `work`. @return the exit status: what `work` returns, 0 after help or
  /// version, 2 where the run could not do what it was asked.
  int run(int argc, char** argv, const std::function<int()>& work);

 private:
  void refuseNoValue(int argc, char** argv) const;
  int outputOr(int status) const;
  void say(const std::string& message) const { tell(name_, message); }

  std::string name_;
  std::unique_ptr<CLI::App> app_;
};

}  // namespace fcl_stpbv::tools
