// Command lines by CLI11. The number checks of CLI11 accept NaN, and read -1 as the largest whole number;
// those of number_check.h do not.
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
#include <set>
#include <utility>

#include "tools/help_text.h"
#include "tools/number_check.h"

namespace fcl_stpbv::tools {
namespace {

constexpr int kWrong = 2;  // a run that tested nothing must differ from one that found nothing

// A longer list of words is part of the option's help, which can be wrapped.
constexpr std::size_t kLongWords = 32;

constexpr const char* kEmpty =
    "the value is empty, as from a shell variable that is not set; give one, or leave the option out";

// Help in the project's own wording, in lines that fit the terminal.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_description(const CLI::App* app) const override {
    return reflowed(app->get_description(), helpColumns());
  }
  std::string make_usage(const CLI::App* app, std::string name) const override {
    return reflowed(CLI::Formatter::make_usage(app, std::move(name)), helpColumns());
  }
  std::string make_footer(const CLI::App* app) const override {
    return reflowed(app->get_footer(), helpColumns());
  }
  std::string make_option(const CLI::Option* option, bool isPlace) const override {
    return entry(make_option_name(option, isPlace) + make_option_opts(option), make_option_desc(option),
                 helpColumns());
  }
  std::string make_option_name(const CLI::Option* option, bool isPlace) const override {
    return CLI::detail::find_and_replace(CLI::Formatter::make_option_name(option, isPlace), "{false}", "");
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    if (option->get_type_size() == 0) return "";
    const bool several = option->get_expected_max() == CLI::detail::expected_max_vector_size;
    return " " + option->get_type_name() + (several ? " ..." : "");
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    std::string text = option->get_description();
    if (!option->get_default_str().empty()) text += " [" + option->get_default_str() + "]";
    if (option->get_required() && option->nonpositional()) text += " (required)";
    return text + listed(" (only with ", option->get_needs()) + listed(" (not with ", option->get_excludes());
  }

 private:
  static std::string listed(const std::string& before, const std::set<CLI::Option*>& options) {
    std::set<std::string> names;  // sorted, so that the order is always the same
    for (const CLI::Option* option : options) {
      const std::string all = option->get_name(false, true);
      names.insert(all.substr(0, all.find(',')));
    }
    return names.empty() ? "" : before + CLI::detail::join(names, ", ") + ")";
  }
};

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
  option_->type_name(orWord.empty() ? "NUMBER" : "NUMBER|" + orWord);
  option_->check(
      [=](const std::string& text) {
        if (!orWord.empty() && text == orWord) return std::string();
        const std::string wrong = wrongNumber(text, least, most, orEqual);
        return wrong.empty() || orWord.empty() ? wrong : wrong + ", or " + orWord;
      },
      "");
  return *this;
}

Option Option::whole(std::uint64_t least, std::uint64_t most) {
  option_->type_name("NUMBER");
  option_->check([=](const std::string& text) { return wrongWholeNumber(text, least, most); }, "");
  return *this;
}

Option Option::oneOf(const std::vector<std::string>& words) {
  const std::string list = CLI::detail::join(words, "|");
  const bool isShort = list.size() <= kLongWords;
  option_->type_name(isShort ? list : "WORD");
  if (!isShort) option_->description(option_->get_description() + ": " + CLI::detail::join(words, ", "));
  option_->check(CLI::IsMember(words).description(""));
  return *this;
}

Option Option::existingFile() {
  option_->type_name("FILE");
  option_->check(CLI::Validator(CLI::ExistingFile).description(""));
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
  app_->formatter(std::make_shared<HelpFormatter>());
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

// Refuses an option without a value after "--option=", because CLI11 would take the next word as its value.
void Program::refuseNoValue(int argc, char** argv) const {
  for (int i = 1; i < argc && std::string(argv[i]) != "--"; ++i) {
    const std::string word = argv[i], name = word.substr(0, word.size() - 1);
    if (word.size() > 3 && word == name + "=" && app_->get_option_no_throw(name) != nullptr)
      throw CLI::ValidationError(name, kEmpty);
  }
}

// The status, or 2 if standard output did not accept everything.
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
