#pragma once

// Subcommands and their options. Only command.cpp, command_line.cpp, completion.cpp and help.cpp include the parser,
// whose header takes a compiler longer than all that is done with it here.

#include <concepts>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace alhazen::impl {

/// An option of a subcommand. What it is asked to be, it returns itself for.
class CommandOption {
 public:
  explicit CommandOption(CLI::Option& option) : option_(&option) {}

  CommandOption& required();
  /// What the help calls the value; empty: nothing.
  CommandOption& value_name(const std::string& name);
  /// The heading of the help under which it is listed.
  CommandOption& group(const std::string& heading);
  /// --help lists it, not only --help-all. A subcommand without any such option lists all in both.
  CommandOption& common();
  /// May be given more than once, with one value each.
  CommandOption& repeatable();
  /// The value may be left out and is then `value`. A word that follows is its value unless it looks like an option or
  /// a file, that is, has a dot or a slash or starts with a dash, and does not end in the port of an address.
  CommandOption& implied(const std::string& value);
  /// One value may hold several, with this character between them.
  CommandOption& separated_by(char separator);
  /// Inclusive limits, which appear in the error but not in the help. NaN is outside.
  CommandOption& within(double low, double high);
  /// `check` throws InputError where a value is none of the option, before the subcommand runs.
  CommandOption& checked(std::function<void(const std::string&)> check);
  template <std::integral Number>
  CommandOption& within(Number low, Number high) {
    return within_integers(low, high);
  }

 private:
  CommandOption& within_integers(int64_t low, int64_t high);

  CLI::Option* option_;
};

/// A subcommand while its options are described. Values must outlive the parsing.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}

  Command add_subcommand(const std::string& name, const std::string& help);
  /// One of its subcommands must be given.
  void require_subcommand();
  /// What is done if it is the one that was given, when all its options have been read.
  void on_run(std::function<void()> run);

  /// `names` are those of an option ("-o,--output"), or one word in capitals for an argument without a name.
  CommandOption add_option(const std::string& names, std::string& value, const std::string& help);
  CommandOption add_option(const std::string& names, int& value, const std::string& help);
  CommandOption add_option(const std::string& names, int64_t& value, const std::string& help);
  CommandOption add_option(const std::string& names, double& value, const std::string& help);
  CommandOption add_option(const std::string& names, std::optional<double>& value, const std::string& help);
  CommandOption add_option(const std::string& names, std::vector<std::string>& values, const std::string& help);
  /// Hands the values over as texts while the command line is parsed; what `set` throws ends the parsing.
  CommandOption add_option(const std::string& names, const std::function<void(const std::string&)>& set,
                           const std::string& help);
  CommandOption add_repeatable_option(const std::string& names, const std::function<void(const std::string&)>& set,
                                      const std::string& help);

  CommandOption add_flag(const std::string& names, bool& value, const std::string& help);
  /// A flag that may have a value; "--stats{text}" is "text" without one.
  CommandOption add_flag(const std::string& names, std::string& value, const std::string& help);
  CommandOption add_flag(const std::string& names, const std::function<void()>& set, const std::string& help);

 private:
  CLI::App* app_;
};

/// The option, "--spp", whose value was refused while the command line was parsed; empty if none was.
const std::string& refused_option();

/// By option, "--denoise": its value where it is given without one.
const std::map<std::string, std::string>& implied_values();

/// What the help and --version of the program say of it.
struct ProgramText {
  std::string name, description, version, footer;
};

/// Parses the command line (command_line.cpp) and runs the subcommand that it names; `add_subcommands` describes them.
/// A file to render as the first word stands for `render`, and --config FILE for the options in that file. Returns 0 if
/// it ran or help was asked for, and exit_bad_input, with a message, where the command line is wrong. Throws what the
/// subcommand throws.
int run_command_line(const ProgramText& text, const std::function<void(Command&)>& add_subcommands, int argc,
                     char** argv);

}  // namespace alhazen::impl
