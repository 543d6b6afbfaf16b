#include "cli/command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

#include "cli/console.h"
#include "cli/subcommands.h"
#include "util/printable.h"

namespace alhazen {

namespace {

/// Unlike CLI::Range it rejects NaN and leaves the help as it is.
template <class Number>
CLI::Validator range_check(Number low, Number high) {
  const auto check = [low, high](std::string& text) {
    Number value{};
    if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return std::string();
    std::ostringstream problem;
    problem.precision(10);
    problem << "Value " << text << " not in range " << low << " to " << high;
    return problem.str();
  };
  return CLI::Validator(check, "");
}

/// The name of a subcommand, also of `study`, that was given but does not exist; else empty.
std::string unknown_subcommand(const CLI::App& app, int argc, char** argv) {
  const auto is_name = [&](int i) { return argc > i && argv[i][0] != '-'; };
  if (!is_name(1)) return {};
  const auto found = app.get_subcommands();
  if (found.empty()) return argv[1];
  const bool has_none_below = found[0]->get_name() == "study" && found[0]->get_subcommands().empty();
  return has_none_below && is_name(2) ? std::string("study ") + argv[2] : std::string();
}

/// The message of an error, with arguments that were not expected in the order given: CLI11 reverses it.
std::string message_of(const CLI::ParseError& error, const CLI::App& app) {
  if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::ExtrasError)) return error.what();
  const std::vector<std::string> unexpected = app.remaining(true);
  std::string message = unexpected.size() == 1 ? "The following argument was not expected:"
                                               : "The following arguments were not expected:";
  for (const std::string& argument : unexpected) message += " " + argument;
  return message;
}

/// The values of options that are given without one.
std::map<std::string, std::string>& implied_values() {
  static std::map<std::string, std::string> values;
  return values;
}

/// The arguments without the program's name, with implied values written out.
std::vector<std::string> complete_arguments(int argc, char** argv) {
  std::vector<std::string> arguments;
  for (int i = 1; i < argc; ++i) {
    arguments.emplace_back(argv[i]);
    if (arguments.back() == "--") {
      arguments.insert(arguments.end(), argv + i + 1, argv + argc);
      break;
    }
    const auto implied = implied_values().find(arguments.back());
    if (implied == implied_values().end()) continue;
    const std::string next = i + 1 < argc ? argv[i + 1] : "";
    if (next.empty() || next[0] == '-' || next.find_first_of("./") != std::string::npos)
      arguments.push_back(implied->second);
  }
  return arguments;
}

}  // namespace

CommandOption& CommandOption::implied(const std::string& value) {
  implied_values()["--" + option_->get_lnames().at(0)] = value;
  return *this;
}

CommandOption& CommandOption::required() {
  option_->required();
  return *this;
}

CommandOption& CommandOption::value_name(const std::string& name) {
  option_->type_name(name);
  return *this;
}

CommandOption& CommandOption::group(const std::string& heading) {
  option_->group(heading);
  return *this;
}

CommandOption& CommandOption::repeatable() {
  option_->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return *this;
}

CommandOption& CommandOption::separated_by(char separator) {
  option_->delimiter(separator);
  return *this;
}

CommandOption& CommandOption::within(double low, double high) {
  option_->check(range_check(low, high));
  return *this;
}

CommandOption& CommandOption::within_integers(int64_t low, int64_t high) {
  option_->check(range_check(low, high));
  return *this;
}

Command Command::add_subcommand(const std::string& name, const std::string& help) {
  return Command(*app_->add_subcommand(name, help));
}

void Command::require_subcommand() { app_->require_subcommand(1); }

void Command::on_run(std::function<void()> run) { app_->callback(std::move(run)); }

CommandOption Command::add_option(const std::string& names, std::string& value, const std::string& help) {
  return CommandOption(*app_->add_option(names, value, help));
}

CommandOption Command::add_option(const std::string& names, int& value, const std::string& help) {
  return CommandOption(*app_->add_option(names, value, help));
}

CommandOption Command::add_option(const std::string& names, int64_t& value, const std::string& help) {
  return CommandOption(*app_->add_option(names, value, help));
}

CommandOption Command::add_option(const std::string& names, double& value, const std::string& help) {
  return CommandOption(*app_->add_option(names, value, help));
}

CommandOption Command::add_option(const std::string& names, std::optional<double>& value, const std::string& help) {
  return CommandOption(*app_->add_option(names, value, help));
}

CommandOption Command::add_option(const std::string& names, std::vector<std::string>& values, const std::string& help) {
  return CommandOption(*app_->add_option(names, values, help));
}

CommandOption Command::add_option(const std::string& names, const std::function<void(const std::string&)>& set,
                                  const std::string& help) {
  return CommandOption(*app_->add_option_function<std::string>(names, set, help));
}

CommandOption Command::add_repeatable_option(const std::string& names,
                                             const std::function<void(const std::string&)>& set,
                                             const std::string& help) {
  const auto set_all = [set](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) set(text);
  };
  return CommandOption(*app_->add_option_function<std::vector<std::string>>(names, set_all, help)).repeatable();
}

CommandOption Command::add_flag(const std::string& names, bool& value, const std::string& help) {
  return CommandOption(*app_->add_flag(names, value, help));
}

CommandOption Command::add_flag(const std::string& names, std::string& value, const std::string& help) {
  return CommandOption(*app_->add_flag(names, value, help));
}

CommandOption Command::add_flag(const std::string& names, const std::function<void()>& set, const std::string& help) {
  return CommandOption(*app_->add_flag_function(
      names, [set](int64_t) { set(); }, help));
}

int run_command_line(const ProgramText& text, const std::function<void(Command&)>& add_subcommands, int argc,
                     char** argv) {
  CLI::App app(text.description, text.name);
  app.set_version_flag("--version", text.version);
  app.footer(text.footer);
  Command program(app);
  program.require_subcommand();
  add_subcommands(program);
  try {
    std::vector<std::string> arguments = complete_arguments(argc, argv);
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
    app.parse(std::move(arguments));
    return exit_done;
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    const std::string unknown = unknown_subcommand(app, argc, argv);
    tell("alhazen: {}\nRun 'alhazen --help' or 'alhazen SUBCOMMAND --help' for the options.\n",
         printable(unknown.empty() ? message_of(error, app) : "there is no subcommand '" + unknown + "'"));
    return exit_bad_input;
  }
}

}  // namespace alhazen
