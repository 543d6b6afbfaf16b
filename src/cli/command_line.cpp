// The command line: what may be left out, options in a file, and messages where it is wrong.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/completion.h"
#include "cli/console.h"
#include "cli/help.h"
#include "cli/option_file.h"
#include "cli/subcommands.h"
#include "util/diagnostics.h"
#include "util/printable.h"
#include "util/quoted.h"

namespace alhazen::impl {

namespace {

/// The name of a subcommand, also of `study`, that was given but does not exist; else empty.
std::string unknown_subcommand(const CLI::App& app, int argc, char** argv) {
  const auto is_name = [&](int i) { return argc > i && argv[i][0] != '-'; };
  if (!is_name(1)) return {};
  const auto found = app.get_subcommands();
  if (found.empty()) return argv[1];
  const bool has_none_below = found[0]->get_name() == "study" && found[0]->get_subcommands().empty();
  return has_none_below && is_name(2) ? std::string("study ") + argv[2] : std::string();
}

/// How many characters have to be inserted, left out or replaced to make one word of the other.
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

/// The question whether the nearest of `names` was meant, if one is near; else nothing.
std::string suggestion(const std::string& word, const std::vector<std::string>& names) {
  const std::string* nearest = nullptr;
  size_t least = std::min<size_t>(2, word.size() / 3) + 1;
  for (const std::string& name : names)
    if (const size_t distance = edit_distance(word, name); distance < least) {
      least = distance;
      nearest = &name;
    }
  return nearest ? ": did you mean " + *nearest + "?" : "";
}

/// The options of the subcommand that was given.
std::vector<std::string> option_names(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  std::vector<std::string> names;
  for (const CLI::Option* option : command->get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// Those of the subcommands, and of what they have below.
std::vector<std::string> subcommand_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
    for (const CLI::App* below : command->get_subcommands([](const CLI::App*) { return true; }))
      names.push_back(command->get_name() + " " + below->get_name());
  }
  return names;
}

/// What CLI11 says of the values of an option, in words of this program; else what it says.
std::string message_of_values(const CLI::ParseError& error) {
  const std::string text = error.what(), kind = error.get_name();
  const std::string name = text.substr(0, text.find(':'));
  if (kind == "ArgumentMismatch" && text.ends_with(" missing")) return name + " needs a value";
  if (kind == "ArgumentMismatch" && text.find("At Most 1 required") != std::string::npos) {
    const std::string times = text.substr(text.rfind(' ') + 1);
    return name + " is given " + (times == "2" ? "twice" : times + " times") + ": give it once";
  }
  if (const size_t end = text.find(" was given a disallowed flag override"); end != std::string::npos)
    return (end > 1 ? "--" : "-") + text.substr(0, end) + " takes no value: give it, or leave it out";
  return text;
}

/// The message of an error, with arguments that were not expected in the order given: CLI11 reverses it.
std::string message_of(const CLI::ParseError& error, const CLI::App& app) {
  if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::ExtrasError)) return message_of_values(error);
  const std::vector<std::string> unexpected = app.remaining(true);
  std::string message = unexpected.size() == 1 ? "The following argument was not expected:"
                                               : "The following arguments were not expected:";
  for (const std::string& argument : unexpected) message += " " + argument;
  for (const std::string& argument : unexpected)
    if (argument.starts_with("--"))
      return message + suggestion(argument.substr(0, argument.find('=')), option_names(app));
  return message;
}

/// Whether the command line names no subcommand, but a file to render, or options of that.
bool renders_by_default(int argc, char** argv) {
  if (argc < 2) return false;
  const std::string_view first = argv[1];
  const auto is_file = [](std::string_view word) {
    return !word.starts_with('-') && word.find_first_of("./") != std::string_view::npos;
  };
  return is_file(first) || (first.starts_with('-') && std::any_of(argv + 2, argv + argc, is_file));
}

/// CLI11 takes the next argument for the value of `--name=`.
void refuse_missing_value(const std::string& argument) {
  if (argument.starts_with("--") && argument.find('=') == argument.size() - 1)
    throw InputError(argument.substr(0, argument.size() - 1) + " needs a value, and there is none after its =");
}

/// Whether it ends as an address does, in a colon and a port: "127.0.0.1:14158".
bool is_address(const std::string& argument) {
  const size_t colon = argument.rfind(':');
  return colon != std::string::npos && colon + 1 < argument.size() &&
         argument.find_first_not_of("0123456789", colon + 1) == std::string::npos;
}

/// The arguments without the program's name, with what may be left out.
std::vector<std::string> complete_arguments(int argc, char** argv) {
  std::vector<std::string> arguments;
  if (renders_by_default(argc, argv)) arguments.emplace_back("render");
  for (int i = 1; i < argc; ++i) {
    arguments.emplace_back(argv[i]);
    refuse_missing_value(arguments.back());
    if (arguments.back() == "--") {
      arguments.insert(arguments.end(), argv + i + 1, argv + argc);
      break;
    }
    const auto implied = implied_values().find(arguments.back());
    if (implied == implied_values().end()) continue;
    const std::string next = i + 1 < argc ? argv[i + 1] : "";
    if (next.empty() || next[0] == '-' || (next.find_first_of("./") != std::string::npos && !is_address(next)))
      arguments.push_back(implied->second);
  }
  return arguments;
}

bool is_given(const CLI::Option& option, const std::vector<std::string>& arguments) {
  return std::any_of(arguments.begin(), arguments.end(), [&](const std::string& argument) {
    if (argument.starts_with("--")) return option.check_name(argument.substr(0, argument.find('=')));
    return argument.size() > 1 && argument[0] == '-' && option.check_sname(argument.substr(1, 1));
  });
}

/// Takes `--config FILE` out of the arguments; returns the file, empty if none is named.
std::string take_configuration(std::vector<std::string>& arguments) {
  const std::string name = "--config";
  std::string path;
  for (size_t i = 1; i < arguments.size() && arguments[i] != "--";) {
    const bool is_apart = arguments[i] == name;
    if (!is_apart && !arguments[i].starts_with(name + "=")) {
      ++i;
      continue;
    }
    if (!path.empty()) throw InputError("give --config once");
    if (!is_apart)
      path = arguments[i].substr(name.size() + 1);
    else if (i + 1 < arguments.size())
      path = arguments[i + 1];
    if (path.empty()) throw InputError("--config needs the name of a file");
    const auto first = arguments.begin() + static_cast<std::ptrdiff_t>(i);
    arguments.erase(first, first + (is_apart ? 2 : 1));
  }
  return path;
}

/// What a file gives for options, by their main names.
using Origins = std::map<std::string, FileOption>;

std::string main_name(const CLI::Option& option) { return option.get_name(); }

[[noreturn]] void refuse_name(const FileOption& item) {
  throw InputError(item.where, quoted(item.name) +
                                   " is no option of 'render': write options by their long names, for "
                                   "example spp = 64");
}

/// The arguments of the command line that mean the same.
std::vector<std::string> arguments_of(const FileOption& item, const CLI::Option& option) {
  const std::string name = "--" + item.name;
  if (option.get_expected_max() == 0) {  // a flag
    if (item.values.size() != 1 || (item.values[0] != "true" && item.values[0] != "false"))
      throw InputError(item.where, quoted(item.name) + " is true or false");
    return item.values[0] == "true" ? std::vector<std::string>{name} : std::vector<std::string>{};
  }
  std::vector<std::string> all;
  std::string joined;
  for (const std::string& value : item.values) {
    all.push_back(name + "=" + value);
    joined += (joined.empty() ? "" : ",") + value;
  }
  // Options that may be repeated take one value at a time, the others all of a list.
  if (option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll) return all;
  const auto implied = implied_values().find(name);
  return {name + "=" + (implied != implied_values().end() && joined == "true" ? implied->second : joined)};
}

/// Writes the options of a file for `render` out as arguments. What stands on the command line counts.
Origins add_configuration(const CLI::App& app, std::vector<std::string>& arguments) {
  const auto is_render = [](const CLI::App* command) { return command->get_name() == "render"; };
  if (arguments.empty() || arguments[0] != "render") return {};
  const std::string path = take_configuration(arguments);
  if (path.empty()) return {};
  const std::vector<std::string> given = arguments;  // of the command line
  const CLI::App& render = *app.get_subcommands(is_render).at(0);
  Origins origins;
  std::vector<std::string> added;
  for (const FileOption& item : read_option_file(path)) {
    const CLI::Option* option = render.get_option_no_throw("--" + item.name);
    if (!option || item.name == "config") refuse_name(item);
    const auto [first, is_new] = origins.try_emplace(main_name(*option), item);
    if (!is_new && option->get_multi_option_policy() != CLI::MultiOptionPolicy::TakeAll)
      throw InputError(item.where, quoted(item.name) + " is given twice, first in line " +
                                       std::to_string(first->second.where.line) + ": give it once");
    const std::vector<std::string> meant = arguments_of(item, *option);
    if (!is_given(*option, given)) added.insert(added.end(), meant.begin(), meant.end());
  }
  arguments.insert(arguments.begin() + 1, added.begin(), added.end());
  return origins;
}

/// Parses, and names the file and the line of a value that is refused there.
void parse(CLI::App& app, std::vector<std::string> arguments, const Origins& origins) {
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
  try {
    app.parse(std::move(arguments));
  } catch (const InputError& error) {
    if (const auto origin = origins.find(refused_option()); origin != origins.end())
      throw InputError(origin->second.where, error.what());
    // Names of backends, layers and the like are looked up later: "unknown backend 'x': it may be ...".
    const std::string message = error.what();
    for (const auto& [name, item] : origins)
      for (const std::string& value : item.values)
        if (message.starts_with("unknown ") && message.find(" " + quoted(value) + ": ") != std::string::npos)
          throw InputError(item.where, message);
    throw;
  }
}

}  // namespace

int run_command_line(const ProgramText& text, const std::function<void(Command&)>& add_subcommands, int argc,
                     char** argv) {
  CLI::App app(text.description, text.name);
  app.set_help_flag("-h,--help", "Print the common options and exit");
  app.set_help_all_flag("--help-all", "Print all options and exit");
  app.formatter_fn([](const CLI::App* command, const std::string& name, CLI::AppFormatMode mode) {
    return help_text(*command, name, mode == CLI::AppFormatMode::All);
  });
  app.set_version_flag("--version", text.version);
  app.footer(text.footer);
  Command program(app);
  program.require_subcommand();
  add_subcommands(program);
  add_completion(app);
  try {
    std::vector<std::string> arguments = complete_arguments(argc, argv);
    const Origins origins = add_configuration(app, arguments);
    parse(app, std::move(arguments), origins);
    return exit_done;
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    const std::string unknown = unknown_subcommand(app, argc, argv);
    tell("alhazen: {}\nRun 'alhazen --help' or 'alhazen SUBCOMMAND --help' for the options.\n",
         printable(unknown.empty()
                       ? message_of(error, app)
                       : "there is no subcommand '" + unknown + "'" + suggestion(unknown, subcommand_names(app))));
    return exit_bad_input;
  }
}

}  // namespace alhazen::impl
