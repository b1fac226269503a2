// What the main of every program does: options in, help and version out, status 2 for a command line that is
// wrong, for an input that cannot be used, and for output that could not be written.
#pragma once

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <functional>
#include <iostream>
#include <limits>
#include <new>
#include <string>

#include "tools/number_check.h"

namespace fcl_stpbv::tools {

class Program : public CLI::App {
 public:
  /// Status of a run that could not do what it was asked: a soak that tested nothing has found nothing.
  static constexpr int kWrong = 2;

  Program(const std::string& description, const std::string& name) : App(description, name) {
    set_version_flag("--version", name + " " FCL_STPBV_VERSION);
  }

  /// A whole number that may be given, in this place if `name` has no dashes.
  template <class Number>
  CLI::Option* whole(const std::string& name, Number& value, const std::string& help, Number least = 1,
                     Number most = std::numeric_limits<Number>::max()) {
    return add_option(name, value, help)
        ->check(wholeNumber(static_cast<std::uint64_t>(least), static_cast<std::uint64_t>(most)))
        ->capture_default_str();
  }
  /// Where random numbers start.
  CLI::Option* seed(const std::string& name, std::uint64_t& value) {
    return whole(name, value, "Of the random numbers", std::uint64_t{0});
  }

  /// Reads the command line and does `work`, which returns the exit status.
  int run(int argc, char** argv, const std::function<int()>& work) {
    int status = kWrong;
    try {
      parse(argc, argv);
      status = work();
    } catch (const CLI::ParseError& error) {
      status = exit(error) == 0 ? 0 : kWrong;
    } catch (const std::bad_alloc&) {
      say("not enough memory; give a smaller input");
    } catch (const std::exception& error) {
      say(error.what());
    }
    return outputIsWhole() ? status : kWrong;
  }

  void say(const std::string& message) const { std::cerr << get_name() << ": " << message << std::endl; }

 private:
  bool outputIsWhole() const {
    errno = 0;
    const bool flushed = std::cout.flush() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
    if (!flushed)
      say(std::string("standard output cannot be written") +
          (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
    return flushed;
  }
};

}  // namespace fcl_stpbv::tools
