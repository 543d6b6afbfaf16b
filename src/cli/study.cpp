// `alhazen study`: measures what each method of accelerating the path tracer gains on this machine, and why.

#include "cli/subcommands.h"

namespace alhazen {

CLI::App* register_study(CLI::App& app, int& exit_code) {
  CLI::App* study = app.add_subcommand("study", "Measure what each method of acceleration gains on this machine");
  study->require_subcommand(1);
  register_study_report(*study, exit_code);
  register_study_tune(*study, exit_code);
  register_study_compare(*study);
  return study;
}

}  // namespace alhazen
