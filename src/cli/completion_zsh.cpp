#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/completion.h"

namespace alhazen::impl {

namespace {

/// Text within '...', as a part of a specification of _arguments or _describe.
std::string zsh_quoted(const std::string& text) {
  std::string quoted;
  for (const char c : text) {
    if (c == '\'')
      quoted += "'\\''";
    else if (c == '[' || c == ']' || c == ':' || c == '\\')
      quoted += std::string("\\") + c;
    else
      quoted += c;
  }
  return quoted;
}

std::string zsh_action(const CompletedValue& value) {
  if (value.kind == CompletedValue::Kind::folder) return "_files -/";
  if (value.kind == CompletedValue::Kind::file)
    return value.extensions.empty() ? "_files"
                                    : fmt::format("_files -g \"*.(#i)({})\"", fmt::join(value.extensions, "|"));
  if (value.words.empty()) return " ";
  if (value.is_list) return fmt::format("_values -s , {} {}", value.name, fmt::join(value.words, " "));
  return fmt::format("({})", fmt::join(value.words, " "));
}

/// The arguments of _arguments: a line for each name of an option.
std::string zsh_options(const CompletedCommand& command) {
  std::string text;
  for (const CompletedOption& option : command.options) {
    const std::string excluded = option.is_repeatable ? "*" : fmt::format("({})", fmt::join(option.names, " "));
    for (const std::string& name : option.names) {
      std::string value;
      const bool has_value = option.value.kind != CompletedValue::Kind::none;
      if (has_value)
        value = fmt::format("{}{}:{}", option.value.is_optional ? "::" : ":", zsh_quoted(option.value.name),
                            zsh_action(option.value));
      const char* const joint = !has_value ? "" : name.starts_with("--") ? "=" : "+";
      text += fmt::format(" \\\n        '{}{}{}[{}]{}'", excluded, name, joint, zsh_quoted(option.description), value);
    }
  }
  return text;
}

std::string zsh_arguments(const CompletedCommand& command) {
  std::string text;
  for (const CompletedValue& value : command.arguments)
    text += fmt::format(" \\\n        ':{}:{}'", zsh_quoted(value.name), zsh_action(value));
  return text;
}

std::string zsh_subcommands(const CompletedCommand& command, const std::vector<CompletedCommand>& commands) {
  std::string text = "        subcommands=(";
  for (const CompletedCommand& each : commands)
    for (const std::string& name : command.subcommands)
      if (each.name == (command.name.empty() ? "" : command.name + " ") + name)
        text += fmt::format("\n          '{}:{}'", name, zsh_quoted(each.description));
  return text + ")\n        _describe -t commands subcommand subcommands\n";
}

}  // namespace

std::string zsh_completion(const std::vector<CompletedCommand>& commands) {
  std::string find, cases;
  for (const CompletedCommand& command : commands) {
    if (!command.name.empty() && command.name.find(' ') == std::string::npos)
      find += fmt::format("      {}) command={}; shift words; (( CURRENT-- )) ;;\n", command.name, command.name);
    cases += fmt::format("    '{}')\n", command.name);
    if (command.subcommands.empty()) {
      cases += fmt::format("      _arguments{}{}\n", zsh_options(command), zsh_arguments(command));
    } else {
      cases += fmt::format("      if [[ $words[CURRENT] == -* ]]; then\n        _arguments{}\n      else\n{}",
                           zsh_options(command), zsh_subcommands(command, commands));
      if (command.name.empty())
        for (const CompletedCommand& render : commands)
          if (render.name == "render") cases += "        " + zsh_action(render.arguments.at(0)) + "\n";
      cases += "      fi\n";
    }
    cases += "      ;;\n";
  }
  std::string below;
  for (const CompletedCommand& command : commands)
    if (!command.name.empty() && !command.subcommands.empty())
      below += fmt::format(
          "  if [[ $command == {} ]] && (( CURRENT > 2 )); then\n    case $words[2] in\n      {})\n"
          "        command+=\" $words[2]\"\n        shift words\n        (( CURRENT-- ))\n        ;;\n"
          "    esac\n  fi\n",
          command.name, fmt::join(command.subcommands, "|"));
  return fmt::format(R"(#compdef alhazen
# Completes the command line of alhazen in zsh. Written by `alhazen completion zsh`.

_alhazen() {{
  local command=
  local -a subcommands
  if (( CURRENT > 2 )); then
    case $words[2] in
{}      -*|*[./]*) command=render ;;
    esac
  fi
{}  case $command in
{}  esac
}}

# Called as a function of fpath, or sourced.
if [[ $funcstack[1] == _alhazen ]]; then
  _alhazen "$@"
else
  compdef _alhazen alhazen
fi
)",
                     find, below, cases);
}

}  // namespace alhazen::impl
