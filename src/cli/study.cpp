// `alhazen study`: measures what each method of accelerating the path tracer gains on this machine, and why.

#include "cli/command.h"
#include "cli/subcommands.h"

namespace alhazen::impl {

void register_study(Command& program, int& exit_code) {
  Command study = program.add_subcommand("study", "Measure what each method of acceleration gains on this machine");
  study.require_subcommand();
  register_study_report(study, exit_code);
  register_study_tune(study, exit_code);
  register_study_compare(study);
}

}  // namespace alhazen::impl
