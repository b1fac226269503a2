// The common parts of every program's main: options, help and version, and status 2 for a wrong command line,
// for an input that cannot be used, and for output that could not be written. CLI11 reads the command line.
// Only program.cpp includes it, because a file that does takes ten seconds to compile.
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

/// An option of a Program, with functions to describe it: `program.option("-n", n, "Runs").whole(1).shown()`.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option required();
  /// The name of the value in the help, if it is neither a number nor one of some words.
  Option type(const std::string& name);
  /// Each time that it is given it takes one value; all count.
  Option repeated();
  /// The help shows the value that holds if the option is not given.
  Option shown();
  /// A finite number from `least` to `most`, without `least` itself unless `orEqual`; or the word `orWord`.
  Option number(double least, double most, bool orEqual = true, const std::string& orWord = "");
  Option whole(std::uint64_t least = 0, std::uint64_t most = std::numeric_limits<std::uint64_t>::max());
  Option oneOf(const std::vector<std::string>& words);
  Option existingFile();
  /// Allowed only together with `other`.
  Option needs(Option other);
  /// Not allowed together with `other`.
  Option excludes(Option other);

 private:
  CLI::Option* option_;
};

/// Writes one message to standard error, after the program's name. Control characters, which names in it may
/// contain, could move the cursor or colour the text, so they become '?'.
void tell(const std::string& program, std::string message);

class Program {
 public:
  Program(const std::string& description, const std::string& name);
  ~Program();

  /// Text below the options in the help. A line that begins with a space stays a line if the terminal has
  /// room for it. Other lines are wrapped again.
  void footer(const std::string& text);
  /// Adds an option. `names` as in "-o,--output", or without dashes for a positional argument. `value` is set
  /// when run() reads the command line, and keeps its value if the option is not given. An empty value is
  /// refused, because it comes from a shell variable that is not set. program.cpp lists the supported types.
  template <class Value>
  Option option(const std::string& names, Value& value, const std::string& help);
  /// An option without a value; "!--no-x" sets `value` to false.
  Option flag(const std::string& names, bool& value, const std::string& help);

  /// Reads the command line and calls `work`. @return the exit status: what `work` returns, 0 after help or
  /// version, 2 if the run could not do what it was asked.
  int run(int argc, char** argv, const std::function<int()>& work);

 private:
  void refuseNoValue(int argc, char** argv) const;
  int outputOr(int status) const;
  void say(const std::string& message) const { tell(name_, message); }

  std::string name_;
  std::unique_ptr<CLI::App> app_;
};

}  // namespace fcl_stpbv::tools
