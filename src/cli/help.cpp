#include "cli/help.h"

#include <CLI/CLI.hpp>
#include <set>
#include <string_view>
#include <vector>

namespace alhazen::impl {

namespace {

constexpr size_t name_columns = 28;

std::set<const CLI::Option*>& common_options() {
  static std::set<const CLI::Option*> options;
  return options;
}

/// The words of a text. One that starts with a dash stays with the word before it: a line that begins with an option
/// is about that option.
std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find(' ', begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    if (word.starts_with('-') && !words.empty())
      words.back().append(" ").append(word);
    else if (!word.empty())
      words.emplace_back(word);
    begin = end + 1;
  }
  return words;
}

/// Lines of `help_columns`, of which those after the first are indented by `indent`; the first has `used` columns
/// already.
std::string wrapped(std::string_view text, size_t indent, size_t used) {
  std::string lines;
  size_t column = used;
  bool is_first = true;
  for (const std::string& word : words_of(text)) {
    if (!is_first && column + 1 + word.size() > help_columns) {
      lines += "\n" + std::string(indent, ' ');
      column = indent;
      is_first = true;
    }
    if (!is_first) lines += ' ';
    lines += word;
    column += word.size() + (is_first ? 0 : 1);
    is_first = false;
  }
  return lines + "\n";
}

/// A name with its description in the column beside it, or below it if the name is too long.
std::string entry(const std::string& name, const std::string& description) {
  std::string line = "  " + name;
  if (line.size() + 2 > name_columns)
    line += "\n" + std::string(name_columns, ' ');
  else
    line.resize(name_columns, ' ');
  return line + wrapped(description, name_columns, name_columns);
}

/// Fits on two lines; words do not fill them.
constexpr size_t short_description = 2 * (help_columns - name_columns) - 4;

std::string entry(const CLI::Option& option, bool whole) {
  std::string name = option.get_name(option.get_positional(), true);
  if (option.get_type_size() != 0 && !option.get_type_name().empty()) name += " " + option.get_type_name();
  return entry(name, whole ? option.get_description() : shortened(option.get_description(), short_description));
}

std::string usage(const CLI::App& app, const std::string& name) {
  std::string text = "Usage: " + name + " [OPTIONS]";
  for (const CLI::Option* option : app.get_options([](const CLI::Option* o) { return o->get_positional(); }))
    text += " " + (option->get_required() ? option->get_name(true) : "[" + option->get_name(true) + "]");
  if (app.get_require_subcommand_min() > 0) text += " SUBCOMMAND";
  return text + "\n";
}

bool has_common_options(const CLI::App& app) {
  return !app.get_options([](const CLI::Option* o) { return common_options().contains(o); }).empty();
}

/// Arguments without a name, and the options by their groups.
std::string groups(const CLI::App& app, bool all) {
  std::string text, arguments;
  for (const CLI::Option* option : app.get_options([](const CLI::Option* o) { return o->get_positional(); }))
    arguments += entry(*option, true);
  if (!arguments.empty()) text += "\n" + arguments;
  const bool lists_all = all || !has_common_options(app);
  for (const std::string& group : app.get_groups()) {
    const auto is_listed = [&](const CLI::Option* o) {
      const bool is_help = o == app.get_help_ptr() || o == app.get_help_all_ptr();
      return o->nonpositional() && o->get_group() == group && (lists_all || is_help || common_options().contains(o));
    };
    const std::vector<const CLI::Option*> options = app.get_options(is_listed);
    if (group.empty() || options.empty()) continue;
    text += "\n" + group + ":\n";
    for (const CLI::Option* option : options) text += entry(*option, lists_all);
  }
  return text;
}

std::vector<const CLI::App*> subcommands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

}  // namespace

std::string shortened(const std::string& description, size_t room) {
  if (description.size() <= room) return description;
  for (const char* const ends : {"; ", ". ", ": "})
    if (const size_t end = description.rfind(ends, room); end != std::string::npos) return description.substr(0, end);
  return description.substr(0, std::min(description.find("; "), description.find(". ")));
}

void mark_common(const CLI::Option& option) { common_options().insert(&option); }

std::string help_text(const CLI::App& app, const std::string& name, bool all) {
  std::string text = wrapped(app.get_description(), 0, 0) + usage(app, name) + groups(app, all);
  if (!subcommands(app).empty()) text += "\nSubcommands:\n";
  for (const CLI::App* command : subcommands(app)) text += entry(command->get_name(), command->get_description());
  const bool is_short = !all && has_common_options(app);
  if (!app.get_footer().empty() && !is_short) text += "\n" + wrapped(app.get_footer(), 0, 0);
  if (!subcommands(app).empty())
    text += "\n'" + name + " SUBCOMMAND --help' lists the options of a subcommand.\n";
  else if (is_short)
    text += "\nThese are the common options: '" + name + " --help-all' lists all of them.\n";
  return text;
}

}  // namespace alhazen::impl
