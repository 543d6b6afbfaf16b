#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/completion.h"

namespace alhazen::impl {

namespace {

constexpr const char* bash_functions =
    R"(# Completes the command line of alhazen in bash. Written by `alhazen completion bash`.

_alhazen_words() {
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$current")
}

# Words with commas between them.
_alhazen_list() {
  local before=
  [[ $current == *,* ]] && before=${current%,*},
  mapfile -t COMPREPLY < <(compgen -P "$before" -W "$1" -- "${current##*,}")
  compopt -o nospace 2>/dev/null
}

# Folders, and files with these extensions, or any.
_alhazen_files() {
  local name extension
  compopt -o filenames 2>/dev/null
  while IFS= read -r name; do
    if [[ -z $1 || -d ${name/#\~\//$HOME/} ]]; then
      COMPREPLY+=("$name")
      continue
    fi
    for extension in $1; do
      [[ ${name,,} == *."$extension" ]] && COMPREPLY+=("$name")
    done
  done < <(compgen -f -- "$current")
}

_alhazen_folders() {
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen -d -- "$current")
}

)";

std::string bash_action(const CompletedValue& value) {
  if (value.kind == CompletedValue::Kind::file)
    return fmt::format("_alhazen_files \"{}\"", fmt::join(value.extensions, " "));
  if (value.kind == CompletedValue::Kind::folder) return "_alhazen_folders";
  if (value.words.empty()) return ":";
  return fmt::format("_alhazen_{} \"{}\"", value.is_list ? "list" : "words", fmt::join(value.words, " "));
}

/// What completes the value of each option that has one.
std::string bash_values(const CompletedCommand& command) {
  std::string text;
  for (const CompletedOption& option : command.options) {
    if (option.value.kind == CompletedValue::Kind::none) continue;
    // A value that may be left out gives way to what may follow in its place.
    const char* const end = option.value.is_optional ? "((${#COMPREPLY[@]})) && return" : "return";
    text += fmt::format("        {})\n          {}\n          {}\n          ;;\n", fmt::join(option.names, " | "),
                        bash_action(option.value), end);
  }
  return text.empty() ? "" : "      case $option in\n" + text + "      esac\n";
}

std::string bash_arguments(const CompletedCommand& command, const CompletedCommand& render) {
  std::string text;
  if (command.name.empty()) text += "        " + bash_action(render.arguments.at(0)) + "\n";
  if (!command.subcommands.empty())
    text +=
        fmt::format("        COMPREPLY+=($(compgen -W \"{}\" -- \"$current\"))\n", fmt::join(command.subcommands, " "));
  else if (!command.arguments.empty())
    text += "        " + bash_action(command.arguments.at(0)) + "\n";
  return text.empty() ? "        :\n" : text;
}

}  // namespace

std::string bash_completion(const std::vector<CompletedCommand>& commands) {
  std::string find, cases;
  const CompletedCommand* render = nullptr;
  for (const CompletedCommand& command : commands) {
    if (command.name == "render") render = &command;
    if (command.name.empty() || command.name.find(' ') != std::string::npos) continue;
    find += fmt::format("      {}) command={} ;;\n", command.name, command.name);
  }
  for (const CompletedCommand& command : commands) {
    std::vector<std::string> names;
    for (const CompletedOption& option : command.options)
      for (const std::string& name : option.names) names.push_back(name);
    cases += fmt::format(
        "    \"{}\")\n{}      if [[ $current == -* ]]; then\n        _alhazen_words \"{}\"\n      else\n{}      fi\n   "
        "   ;;\n",
        command.name, bash_values(command), fmt::join(names, " "), bash_arguments(command, *render));
  }
  std::string below;
  for (const CompletedCommand& command : commands)
    if (!command.name.empty() && !command.subcommands.empty())
      below += fmt::format(
          "    if [[ $command == {} ]] && ((COMP_CWORD > 2)); then\n      case ${{COMP_WORDS[2]}} in\n"
          "        {}) command+=\" ${{COMP_WORDS[2]}}\" ;;\n      esac\n    fi\n",
          command.name, fmt::join(command.subcommands, " | "));
  return bash_functions + fmt::format(
                              R"(_alhazen() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} option=${{COMP_WORDS[COMP_CWORD - 1]}} command=
  COMPREPLY=()
  # --name=value is three words.
  if [[ $current == = ]]; then
    current=
  elif [[ $option == = ]]; then
    option=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
  if ((COMP_CWORD > 1)); then
    case ${{COMP_WORDS[1]}} in
{}      -* | *[./]*) command=render ;;
    esac
{}  fi
  case $command in
{}  esac
}}

complete -F _alhazen alhazen
)",
                              find, below, cases);
}

}  // namespace alhazen::impl
