#include "cli/completion.h"

#include <CLI/CLI.hpp>
#include <cctype>
#include <map>
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/help.h"
#include "render/quality.h"
#include "render/settings.h"
#include "study/report.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

namespace {

constexpr size_t completion_columns = 72;  // of a description; shells put it beside the option

/// Words that values of options may be, by the options' names. tests/cli/completion_test.sh compares them with what the
/// program says of a value that it does not know.
std::map<std::string, std::vector<std::string>> words_of_options() {
  std::map<std::string, std::vector<std::string>> words{
      {"--aov-surface", {"first", "diffuse"}},
      {"--backend", {"auto", "serial", "openmp", "embree", "cuda", "optix"}},
      {"--coats", {"lossless", "pbrt"}},
      {"--denoise", {"auto", "optix", "oidn", "builtin", "none"}},
      {"--device", {"all", "host"}},
      {"--exposure", {"auto"}},
      {"--exr-compression", {"zip", "zips", "piz", "rle", "none", "dwaa", "dwab"}},
      {"--exr-type", {"half", "float"}},
      {"--filter", {"box", "triangle", "gaussian", "mitchell", "sinc"}},
      {"--format", {"png", "exr", "jpg", "hdr", "pfm"}},
      {"--guiding", {"off", "on", "auto"}},
      {"--integrator", {"path", "iterative", "recursive", "branching"}},
      {"--noise", {"none"}},
      {"--png-depth", {"8", "16"}},
      {"--precision", {"float", "double"}},
      {"--progress", {"auto", "plain", "json", "none"}},
      {"--sampler", {"sobol", "zsobol", "independent"}},
      {"--schedule", {"static", "dynamic", "guided"}},
      {"--stats", {"text", "json"}},
      {"--strategy",
       {"auto", "tiles", "rows", "collapse", "rows+reduction", "reduction", "persistent", "pixel", "chunk", "wavefront",
        "megakernel"}},
      {"--tone-map", {"none", "reinhard", "filmic", "aces", "agx"}},
      {"--white-balance", {"auto", "off"}},
      {"--only", study::report_parts()},
  };
  for (const NamedLayer& layer : layer_table()) words["--aov"].emplace_back(layer.name);
  for (const Quality& quality : qualities()) words["--quality"].emplace_back(quality.name);
  return words;
}

/// The extensions that a description names: ".exr, .png or .gif".
std::vector<std::string> named_extensions(const std::string& description) {
  std::vector<std::string> extensions;
  for (size_t dot = description.find('.'); dot != std::string::npos; dot = description.find('.', dot + 1)) {
    if (dot > 0 && description[dot - 1] != ' ' && description[dot - 1] != '(') continue;
    size_t end = dot + 1;
    while (end < description.size() && std::isalnum(static_cast<unsigned char>(description[end])) != 0) ++end;
    if (end > dot + 1) extensions.push_back(description.substr(dot + 1, end - dot - 1));
  }
  return extensions;
}

CompletedValue completed_value(const CLI::Option& option, const std::string& long_name) {
  CompletedValue value;
  const bool is_argument = option.get_positional();
  if (!is_argument && (option.get_type_size() == 0 || option.get_type_name().empty())) return value;
  value.name = is_argument ? option.get_name(true) : option.get_type_name();
  value.is_optional = value.name.starts_with('[');
  if (value.is_optional) value.name = value.name.substr(1, value.name.size() - 2);
  value.kind = CompletedValue::Kind::any;
  if (value.name.starts_with("DIR")) value.kind = CompletedValue::Kind::folder;
  if (is_argument || value.name.starts_with("FILE")) {
    value.kind = CompletedValue::Kind::file;
    value.extensions = named_extensions(option.get_description());
  }
  static const std::map<std::string, std::vector<std::string>> words = words_of_options();
  if (const auto found = words.find(long_name); found != words.end()) value.words = found->second;
  value.is_list = value.name == "NAMES" || value.name == "PARTS";
  return value;
}

CompletedOption completed_option(const CLI::Option& option) {
  CompletedOption completed;
  for (const std::string& name : option.get_snames()) completed.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) completed.names.push_back("--" + name);
  completed.description = shortened(option.get_description(), completion_columns);
  completed.value = completed_value(option, "--" + option.get_lnames().at(0));
  completed.is_repeatable = option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
  return completed;
}

void add_completed(const CLI::App& app, const std::string& name, std::vector<CompletedCommand>& commands) {
  CompletedCommand command{name, app.get_description(), {}, {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional())
      command.arguments.push_back(completed_value(*option, ""));
    else
      command.options.push_back(completed_option(*option));
  }
  const auto below = app.get_subcommands([](const CLI::App*) { return true; });
  for (const CLI::App* subcommand : below) command.subcommands.push_back(subcommand->get_name());
  commands.push_back(std::move(command));
  for (const CLI::App* subcommand : below)
    add_completed(*subcommand, (name.empty() ? "" : name + " ") + subcommand->get_name(), commands);
}

std::string completion_for(const std::string& shell, const std::vector<CompletedCommand>& commands) {
  if (shell == "bash") return bash_completion(commands);
  if (shell == "zsh") return zsh_completion(commands);
  if (shell == "fish") return fish_completion(commands);
  throw InputError("unknown shell '" + shell + "': it may be bash, zsh, fish");
}

}  // namespace

std::vector<CompletedCommand> completed_commands(const CLI::App& program) {
  std::vector<CompletedCommand> commands;
  add_completed(program, "", commands);
  for (CompletedCommand& command : commands)
    if (command.name == "completion")
      command.arguments.at(0) = {CompletedValue::Kind::any, "SHELL", {"bash", "zsh", "fish"}, {}};
  return commands;
}

void add_completion(CLI::App& program) {
  Command command =
      Command(program).add_subcommand("completion", "Print a script that completes the command line in a shell");
  auto shell = std::make_shared<std::string>();
  command.add_option("SHELL", *shell, "bash, zsh or fish; docs/packages.md says where the script belongs")
      .required()
      .value_name("");
  command.on_run([shell, &program] { print_text(completion_for(*shell, completed_commands(program))); });
}

}  // namespace alhazen::impl
