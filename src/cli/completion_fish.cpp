#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/completion.h"

namespace alhazen::impl {

namespace {

std::string fish_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "'";
}

/// The part of `complete` that says what the value may be.
std::string fish_value(const CompletedValue& value, bool is_option) {
  const char* const needed = is_option && !value.is_optional ? " -r" : "";
  switch (value.kind) {
    case CompletedValue::Kind::none:
      return "";
    case CompletedValue::Kind::folder:
      return fmt::format("{} -a '(__fish_complete_directories)'", needed);
    case CompletedValue::Kind::file:
      return value.extensions.empty()
                 ? fmt::format("{} -F", needed)
                 : fmt::format("{} -k -a '(__alhazen_files {})'", needed, fmt::join(value.extensions, " "));
    case CompletedValue::Kind::any:
      break;
  }
  if (value.words.empty()) return needed;
  if (value.is_list) return fmt::format("{} -a '(__fish_append , {})'", needed, fmt::join(value.words, " "));
  return fmt::format("{} -a '{}'", needed, fmt::join(value.words, " "));
}

std::string fish_condition(const CompletedCommand& command) {
  return fmt::format("complete -c alhazen -n '__alhazen_is \"{}\"'", command.name);
}

std::string fish_lines(const CompletedCommand& command, const std::vector<CompletedCommand>& commands) {
  std::string text;
  for (const CompletedOption& option : command.options) {
    text += fish_condition(command);
    for (const std::string& name : option.names)
      text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    text += fmt::format("{} -d {}\n", fish_value(option.value, true), fish_quoted(option.description));
  }
  for (const CompletedCommand& each : commands)
    for (const std::string& name : command.subcommands)
      if (each.name == (command.name.empty() ? "" : command.name + " ") + name)
        text += fmt::format("{} -a {} -d {}\n", fish_condition(command), name, fish_quoted(each.description));
  if (command.subcommands.empty() && !command.arguments.empty())
    text += fish_condition(command) + fish_value(command.arguments.at(0), false) + "\n";
  return text;
}

}  // namespace

std::string fish_completion(const std::vector<CompletedCommand>& commands) {
  std::string find, lines;
  for (const CompletedCommand& command : commands) {
    lines += fish_lines(command, commands);
    if (command.name == "render")
      lines +=
          fmt::format("complete -c alhazen -n '__alhazen_is \"\"'{}\n", fish_value(command.arguments.at(0), false));
    if (command.name.empty() || command.name.find(' ') != std::string::npos) continue;
    if (command.subcommands.empty()) {
      find += fmt::format("    case {}\n      echo {}\n", command.name, command.name);
    } else {
      find += fmt::format(
          "    case {}\n      if test (count $words) -gt 2; and contains -- $words[3] {}\n        echo \"{} "
          "$words[3]\"\n"
          "      else\n        echo {}\n      end\n",
          command.name, fmt::join(command.subcommands, " "), command.name, command.name);
    }
  }
  return fmt::format(R"(# Completes the command line of alhazen in fish. Written by `alhazen completion fish`.

# The subcommand before the cursor.
function __alhazen_command
  set -l words (commandline -opc)
  test (count $words) -gt 1; or return
  switch $words[2]
{}    case '-*' '*.*' '*/*'
      echo render
  end
end

function __alhazen_is
  set -l command (__alhazen_command)
  test "$command" = "$argv"
end

# Folders, and files with these extensions.
function __alhazen_files
  __fish_complete_path (commandline -ct) | string match -ri '^[^\t]*(?:/|\.(?:'(string join '|' -- $argv)'))(?:\t.*)?$'
end

complete -c alhazen -f
{})",
                     find, lines);
}

}  // namespace alhazen::impl
