// The program `alhazen`: parses the command line and turns errors into one message and an exit code.

#include <fmt/format.h>

#include <exception>
#include <new>
#include <string>
#include <system_error>

#include "cli/console.h"
#include "cli/stack.h"
#include "cli/subcommands.h"
#include "util/diagnostics.h"
#include "util/printable.h"

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

int parse_and_run(CLI::App& app, int argc, char** argv, int& exit_code) {
  try {
    app.parse(argc, argv);
    return exit_code;
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    const std::string unknown = unknown_subcommand(app, argc, argv);
    alhazen::tell("alhazen: {}\nRun 'alhazen --help' or 'alhazen SUBCOMMAND --help' for the options.\n",
                  alhazen::printable(unknown.empty() ? error.what() : "there is no subcommand '" + unknown + "'"));
    return alhazen::exit_bad_input;
  }
}

/// Turns whatever `body` throws into a message and an exit code.
template <class Body>
int run_guarded(const Body& body) {
  try {
    return body();
  } catch (const alhazen::InputError& error) {
    alhazen::tell("{}\n", error.what());
    return alhazen::exit_bad_input;
  } catch (const std::bad_alloc&) {
    // A text that is ready, since formatting one takes memory.
    alhazen::tell_text("alhazen: out of memory: the task needs more than this machine, or a limit set on it, allows\n");
    return alhazen::exit_failed;
  } catch (const alhazen::RenderError& error) {  // may have several lines
    alhazen::tell("alhazen: {}\n", error.what());
    return alhazen::exit_failed;
  } catch (const std::system_error& error) {
    const bool is_limit = error.code() == std::errc::resource_unavailable_try_again;
    alhazen::tell(
        "alhazen: {}{}\n", alhazen::printable(error.what()),
        is_limit ? ": the system refuses a thread or memory: raise the limits (ulimit -u, ulimit -v, ulimit -d)" : "");
    return alhazen::exit_failed;
  } catch (const std::exception& error) {
    alhazen::tell("alhazen: {}\n", alhazen::printable(error.what()));
    return alhazen::exit_failed;
  }
}

/// It is a failure if output cannot be written, for example to a full disk.
int after_flushing(int exit_code) {
  const std::string problem = alhazen::flush_output();
  if (problem.empty()) return exit_code;
  alhazen::tell("alhazen: {}\n", problem);
  return exit_code == alhazen::exit_done ? alhazen::exit_failed : exit_code;
}

int run_command_line(int argc, char** argv) {
  CLI::App app("A path tracer whose light transport is written once and run by many engines.", "alhazen");
  app.set_version_flag("--version", "alhazen " ALHAZEN_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 1 failed while rendering or writing, 2 bad usage or bad input, 130 interrupted by Ctrl-C, "
      "SIGTERM, SIGHUP or SIGXCPU (the image so far is written).");
  int exit_code = alhazen::exit_done;
  alhazen::register_render(app, exit_code);
  alhazen::register_compare(app);
  alhazen::register_devices(app);
  alhazen::register_info(app);
  alhazen::register_study(app, exit_code);
  return parse_and_run(app, argc, argv, exit_code);
}

int run_program(int argc, char** argv) {
  alhazen::prepare_streams();
  const int exit_code = run_guarded([&] { return run_command_line(argc, argv); });
  return run_guarded([&] { return after_flushing(exit_code); });
}

}  // namespace

int main(int argc, char** argv) {
  return run_guarded([&] { return alhazen::run_on_enough_stack([&] { return run_program(argc, argv); }); });
}
