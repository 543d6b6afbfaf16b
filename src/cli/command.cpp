#include "cli/command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

#include "cli/help.h"

namespace alhazen::impl {

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

/// The values of options that are given without one.
std::map<std::string, std::string>& mutable_implied_values() {
  static std::map<std::string, std::string> values;
  return values;
}

}  // namespace

const std::map<std::string, std::string>& implied_values() { return mutable_implied_values(); }

CommandOption& CommandOption::implied(const std::string& value) {
  mutable_implied_values()["--" + option_->get_lnames().at(0)] = value;
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

CommandOption& CommandOption::common() {
  mark_common(*option_);
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

}  // namespace alhazen::impl
