// Command lines by CLI11. Its own checks of numbers let NaN through, and take -1 for the largest whole
// number; number_check.h does neither.
#include "tools/program.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>
#include <optional>

#include "tools/number_check.h"

namespace fcl_stpbv::tools {
namespace {

constexpr int kWrong = 2;  // a run that tested nothing must not look like one that found nothing

constexpr const char* kEmpty =
    "the value is empty, as from a shell variable that is not set; give one, or leave the option out";

}  // namespace

Option Option::required() {
  option_->required();
  return *this;
}

Option Option::type(const std::string& name) {
  option_->type_name(name);
  return *this;
}

Option Option::repeated() {
  option_->expected(1)->take_all();
  return *this;
}

Option Option::shown() {
  option_->capture_default_str();
  return *this;
}

Option Option::number(double least, double most, bool orEqual, const std::string& orWord) {
  option_->check(
      [=](const std::string& text) {
        if (!orWord.empty() && text == orWord) return std::string();
        const std::string wrong = wrongNumber(text, least, most, orEqual);
        return wrong.empty() || orWord.empty() ? wrong : wrong + ", or " + orWord;
      },
      "NUMBER");
  return *this;
}

Option Option::whole(std::uint64_t least, std::uint64_t most) {
  option_->check([=](const std::string& text) { return wrongWholeNumber(text, least, most); }, "NUMBER");
  return *this;
}

Option Option::oneOf(const std::vector<std::string>& words) {
  option_->check(CLI::IsMember(words));
  return *this;
}

Option Option::existingFile() {
  option_->check(CLI::ExistingFile);
  return *this;
}

Option Option::needs(Option other) {
  option_->needs(other.option_);
  return *this;
}

Option Option::excludes(Option other) {
  option_->excludes(other.option_);
  return *this;
}

Program::Program(const std::string& description, const std::string& name)
    : name_(name), app_(std::make_unique<CLI::App>(description, name)) {
  app_->set_version_flag("--version", name + " " FCL_STPBV_VERSION);
}

Program::~Program() = default;

void Program::footer(const std::string& text) { app_->footer(text); }

template <class Value>
Option Program::option(const std::string& names, Value& value, const std::string& help) {
  CLI::Option* const option = app_->add_option(names, value, help);
  option->check([](const std::string& text) { return std::string(text.empty() ? kEmpty : ""); }, "");
  return Option(option);
}

template Option Program::option(const std::string&, double&, const std::string&);
template Option Program::option(const std::string&, int&, const std::string&);
template Option Program::option(const std::string&, long&, const std::string&);
template Option Program::option(const std::string&, std::uint64_t&, const std::string&);
template Option Program::option(const std::string&, std::string&, const std::string&);
template Option Program::option(const std::string&, std::optional<double>&, const std::string&);
template Option Program::option(const std::string&, std::optional<int>&, const std::string&);
template Option Program::option(const std::string&, std::optional<std::string>&, const std::string&);
template Option Program::option(const std::string&, std::vector<int>&, const std::string&);
template Option Program::option(const std::string&, std::vector<std::string>&, const std::string&);

Option Program::flag(const std::string& names, bool& value, const std::string& help) {
  return Option(app_->add_flag(names, value, help));
}

int Program::run(int argc, char** argv, const std::function<int()>& work) {
  int status = kWrong;
  try {
    refuseNoValue(argc, argv);
    app_->parse(argc, argv);
    status = work();
  } catch (const CLI::ExcludesError& error) {
    say(std::string(error.what()) + "; give only one of them");
  } catch (const CLI::ParseError& error) {
    status = app_->exit(error) == 0 ? 0 : kWrong;
  } catch (const std::bad_alloc&) {
    say("not enough memory; give a smaller input");
  } catch (const std::exception& error) {
    say(error.what());
  }
  return outputOr(status);
}

// CLI11 would take the word after "--option=" for its value.
void Program::refuseNoValue(int argc, char** argv) const {
  for (int i = 1; i < argc && std::string(argv[i]) != "--"; ++i) {
    const std::string word = argv[i], name = word.substr(0, word.size() - 1);
    if (word.size() > 3 && word == name + "=" && app_->get_option_no_throw(name) != nullptr)
      throw CLI::ValidationError(name, kEmpty);
  }
}

// The status, or 2 where standard output did not take all of it.
int Program::outputOr(int status) const {
  errno = 0;
  if (std::cout.flush() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  say(std::string("standard output cannot be written") +
      (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
  return kWrong;
}

void tell(const std::string& program, std::string message) {
  std::replace_if(
      message.begin(), message.end(),
      [](unsigned char c) { return (c < ' ' && c != '\n' && c != '\t') || c == 0x7f; }, '?');
  std::cerr << program << ": " << message << std::endl;
}

}  // namespace fcl_stpbv::tools
