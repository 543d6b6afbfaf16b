#include "cli/command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <type_traits>
#include <utility>

#include "cli/help.h"
#include "util/diagnostics.h"
#include "util/parse_numbers.h"
#include "util/quoted.h"

namespace alhazen::impl {

namespace {

std::string& mutable_refused_option() {
  static std::string name;
  return name;
}

/// Remembers the option that has the value which `use` refuses.
template <class Use>
void guard(const std::string& name, const Use& use) {
  try {
    use();
  } catch (const InputError&) {
    mutable_refused_option() = name;
    throw;
  }
}

/// "--output" of "-o,--output,--outfile".
std::string main_name(const std::string& names) {
  const size_t at = names.find("--");
  return at == std::string::npos ? names : names.substr(at, names.find(',', at) - at);
}

template <class Number>
constexpr const char* kind_of_number = std::is_integral_v<Number> ? "a whole number" : "a finite number";

template <class Number>
bool parse_finite_number(const std::string& text, Number& value) {
  if (!parse_number(text, value)) return false;
  if constexpr (std::is_floating_point_v<Number>) return std::isfinite(value);
  return true;
}

template <class Number>
CLI::Validator range_check(const std::string& name, Number low, Number high) {
  const auto check = [=](std::string& text) {
    guard(name, [&] {
      Number value{};
      if (parse_finite_number(text, value) && value >= low && value <= high) return;
      const auto shown = [](Number limit) {
        if constexpr (std::is_floating_point_v<Number>) return fmt::format("{:.10g}", limit);
        return fmt::format("{}", limit);
      };
      throw InputError(fmt::format("{} must be {} from {} to {}, not {}", name, kind_of_number<Number>, shown(low),
                                   shown(high), quoted(text)));
    });
    return std::string();
  };
  return CLI::Validator(check, "");
}

/// An option whose number is parsed as everywhere else, with the same words where it is none.
template <class Number, class Value>
CLI::Option* add_number(CLI::App& app, const std::string& names, Value& value, const std::string& help) {
  const auto set = [name = main_name(names), &value](const std::string& text) {
    guard(name, [&] {
      Number number{};
      if (!parse_finite_number(text, number))
        throw InputError(fmt::format("{} must be {}, not {}", name, kind_of_number<Number>, quoted(text)));
      value = number;
    });
  };
  return app.add_option_function<std::string>(names, set, help);
}

/// An empty text would count as an option that is not given.
void refuse_empty(CLI::Option& option, const std::string& names) {
  if (!names.starts_with('-')) return;
  const auto check = [name = main_name(names)](std::string& text) {
    guard(name, [&] {
      if (text.empty()) throw InputError(name + " needs a value, and is given an empty one");
    });
    return std::string();
  };
  option.check(CLI::Validator(check, ""));
}

/// The values of options that are given without one.
std::map<std::string, std::string>& mutable_implied_values() {
  static std::map<std::string, std::string> values;
  return values;
}

}  // namespace

const std::string& refused_option() { return mutable_refused_option(); }

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
  option_->expected(1)->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return *this;
}

CommandOption& CommandOption::separated_by(char separator) {
  option_->delimiter(separator);
  return *this;
}

CommandOption& CommandOption::within(double low, double high) {
  option_->check(range_check(main_name(option_->get_name(false, true)), low, high));
  return *this;
}

CommandOption& CommandOption::within_integers(int64_t low, int64_t high) {
  option_->check(range_check(main_name(option_->get_name(false, true)), low, high));
  return *this;
}

CommandOption& CommandOption::checked(std::function<void(const std::string&)> check) {
  const auto guarded = [name = main_name(option_->get_name(false, true)), check = std::move(check)](std::string& text) {
    guard(name, [&] { check(text); });
    return std::string();
  };
  option_->check(CLI::Validator(guarded, ""));
  return *this;
}

Command Command::add_subcommand(const std::string& name, const std::string& help) {
  return Command(*app_->add_subcommand(name, help));
}

void Command::require_subcommand() { app_->require_subcommand(1); }

void Command::on_run(std::function<void()> run) { app_->callback(std::move(run)); }

CommandOption Command::add_option(const std::string& names, std::string& value, const std::string& help) {
  CLI::Option* const option = app_->add_option(names, value, help);
  refuse_empty(*option, names);
  return CommandOption(*option);
}

CommandOption Command::add_option(const std::string& names, int& value, const std::string& help) {
  return CommandOption(*add_number<int>(*app_, names, value, help));
}

CommandOption Command::add_option(const std::string& names, int64_t& value, const std::string& help) {
  return CommandOption(*add_number<int64_t>(*app_, names, value, help));
}

CommandOption Command::add_option(const std::string& names, double& value, const std::string& help) {
  return CommandOption(*add_number<double>(*app_, names, value, help));
}

CommandOption Command::add_option(const std::string& names, std::optional<double>& value, const std::string& help) {
  return CommandOption(*add_number<double>(*app_, names, value, help));
}

CommandOption Command::add_option(const std::string& names, std::vector<std::string>& values, const std::string& help) {
  CLI::Option* const option = app_->add_option(names, values, help);
  refuse_empty(*option, names);
  return CommandOption(*option);
}

CommandOption Command::add_option(const std::string& names, const std::function<void(const std::string&)>& set,
                                  const std::string& help) {
  const auto guarded = [name = main_name(names), set](const std::string& text) { guard(name, [&] { set(text); }); };
  return CommandOption(*app_->add_option_function<std::string>(names, guarded, help));
}

CommandOption Command::add_repeatable_option(const std::string& names,
                                             const std::function<void(const std::string&)>& set,
                                             const std::string& help) {
  const auto set_all = [name = main_name(names), set](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) guard(name, [&] { set(text); });
  };
  return CommandOption(*app_->add_option_function<std::vector<std::string>>(names, set_all, help)).repeatable();
}

CommandOption Command::add_flag(const std::string& names, bool& value, const std::string& help) {
  return CommandOption(*app_->add_flag(names, value, help)->disable_flag_override());
}

CommandOption Command::add_flag(const std::string& names, std::string& value, const std::string& help) {
  return CommandOption(*app_->add_flag(names, value, help));
}

CommandOption Command::add_flag(const std::string& names, const std::function<void()>& set, const std::string& help) {
  const auto guarded = [name = main_name(names), set](int64_t) { guard(name, set); };
  return CommandOption(*app_->add_flag_function(names, guarded, help)->disable_flag_override());
}

}  // namespace alhazen::impl
