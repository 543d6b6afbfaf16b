#pragma once

// `alhazen completion`: scripts that complete the command line in shells, made from the options that it has.

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace alhazen::impl {

/// What may be the value of an option, or an argument without a name.
struct CompletedValue {
  enum class Kind { none, any, file, folder };
  Kind kind = Kind::none;
  std::string name;                     ///< as help calls it
  std::vector<std::string> words;       ///< some or all values, if they are words
  std::vector<std::string> extensions;  ///< of files, without the dots; empty: any file
  bool is_optional = false;
  bool is_list = false;  ///< of words, with commas between them
};

struct CompletedOption {
  std::vector<std::string> names;  ///< with their dashes; of one letter, and longer ones
  std::string description;         ///< one line
  CompletedValue value;
  bool is_repeatable = false;
};

struct CompletedCommand {
  std::string name;  ///< "render", "study report"; empty: the program
  std::string description;
  std::vector<CompletedOption> options;
  std::vector<CompletedValue> arguments;
  std::vector<std::string> subcommands;
};

/// The program first, then its subcommands and theirs.
std::vector<CompletedCommand> completed_commands(const CLI::App& program);

std::string bash_completion(const std::vector<CompletedCommand>& commands);
std::string zsh_completion(const std::vector<CompletedCommand>& commands);
std::string fish_completion(const std::vector<CompletedCommand>& commands);

/// Adds the subcommand `completion` to the program.
void add_completion(CLI::App& program);

}  // namespace alhazen::impl
