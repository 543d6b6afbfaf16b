// The program `alhazen`: parses the command line and turns errors into one message and an exit code.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/stack.h"
#include "cli/subcommands.h"
#include "render/sample_kernel.h"
#include "util/diagnostics.h"
#include "util/printable.h"

namespace {

/// Turns whatever `body` throws into a message and an exit code.
template <class Body>
int run_guarded(const Body& body) {
  try {
    return body();
  } catch (const alhazen::InputError& error) {
    alhazen::impl::tell("{}\n", error.what());
    return alhazen::impl::exit_bad_input;
  } catch (const alhazen::impl::UnsupportedError& error) {
    alhazen::impl::tell("{}\n", error.what());
    return alhazen::impl::exit_bad_input;
  } catch (const alhazen::impl::TooLargeError& error) {
    alhazen::impl::tell("{}\n", error.what());
    return alhazen::impl::exit_bad_input;
  } catch (const std::bad_alloc&) {
    // A text that is ready, since formatting one takes memory.
    alhazen::impl::tell_text(
        "alhazen: out of memory: the task needs more than this machine, or a limit set on it, allows\n");
    return alhazen::impl::exit_failed;
  } catch (const alhazen::Error& error) {  // may have several lines
    alhazen::impl::tell("alhazen: {}\n", error.what());
    return alhazen::impl::exit_failed;
  } catch (const std::system_error& error) {
    const bool is_limit = error.code() == std::errc::resource_unavailable_try_again;
    alhazen::impl::tell(
        "alhazen: {}{}\n", alhazen::impl::printable(error.what()),
        is_limit ? ": the system refuses a thread or memory: raise the limits (ulimit -u, ulimit -v, ulimit -d)" : "");
    return alhazen::impl::exit_failed;
  } catch (const std::exception& error) {
    alhazen::impl::tell("alhazen: {}\n", alhazen::impl::printable(error.what()));
    return alhazen::impl::exit_failed;
  }
}

/// It is a failure if output cannot be written, for example to a full disk.
int after_flushing(int exit_code) {
  const std::string problem = alhazen::impl::flush_output();
  if (problem.empty()) return exit_code;
  alhazen::impl::tell("alhazen: {}\n", problem);
  return exit_code == alhazen::impl::exit_done ? alhazen::impl::exit_failed : exit_code;
}

std::string version_text() {
  std::vector<std::string> sets;
  for (const alhazen::impl::InstructionSet set : alhazen::impl::built_instruction_sets())
    sets.push_back(alhazen::impl::to_string(set) +
                   (set == alhazen::impl::instruction_sets().back() ? " (used here)" : ""));
  return fmt::format(
      "alhazen {}\nkernels for {}; compiler {}\n'alhazen devices' lists backends and denoisers, and says what is "
      "missing for the others.",
      ALHAZEN_VERSION, fmt::join(sets, ", "), __VERSION__);
}

int run_subcommand(int argc, char** argv) {
  alhazen::impl::ProgramText text;
  text.name = "alhazen";
  text.description = "A path tracer whose light transport is written once and run by many engines.";
  text.version = version_text();
  text.footer =
      "Exit codes: 0 done, 1 failed while rendering or writing, 2 bad usage or bad input, 130 interrupted by Ctrl-C, "
      "SIGTERM, SIGHUP or SIGXCPU (the image so far is written).";
  int exit_code = alhazen::impl::exit_done;
  const auto add_subcommands = [&](alhazen::impl::Command& program) {
    alhazen::impl::register_render(program, exit_code);
    alhazen::impl::register_view(program, exit_code);
    alhazen::impl::register_compare(program, exit_code);
    alhazen::impl::register_devices(program);
    alhazen::impl::register_info(program);
    alhazen::impl::register_study(program, exit_code);
  };
  const int parsed = alhazen::impl::run_command_line(text, add_subcommands, argc, argv);
  return parsed == alhazen::impl::exit_done ? exit_code : parsed;
}

int run_program(int argc, char** argv) {
  alhazen::impl::prepare_streams();
  const int exit_code = run_guarded([&] { return run_subcommand(argc, argv); });
  return run_guarded([&] { return after_flushing(exit_code); });
}

}  // namespace

int main(int argc, char** argv) {
  return run_guarded([&] { return alhazen::impl::run_on_enough_stack([&] { return run_program(argc, argv); }); });
}
