// The program `alhazen`: parses the command line, turns errors into one message and an exit code.

#include <fmt/format.h>

#include <exception>
#include <new>

#include "cli/subcommands.h"
#include "scene/diagnostics.h"

namespace {

int parse_and_run(CLI::App& app, int argc, char** argv, int& exit_code) {
  try {
    app.parse(argc, argv);
    return exit_code;
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "alhazen: {}\nRun 'alhazen --help' or 'alhazen SUBCOMMAND --help' for what may be given.\n",
               error.what());
    return alhazen::exit_bad_input;
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("A path tracer whose light transport is written once and run by many engines.", "alhazen");
  app.set_version_flag("--version", "alhazen " ALHAZEN_VERSION);
  app.require_subcommand(1);
  app.footer("Exit codes: 0 done, 1 failed while rendering, 2 bad usage or bad input, 130 interrupted (the picture so "
             "far is written).");
  int exit_code = alhazen::exit_done;
  alhazen::register_render(app, exit_code);
  alhazen::register_compare(app);
  alhazen::register_devices(app);
  alhazen::register_info(app);
  try {
    return parse_and_run(app, argc, argv, exit_code);
  } catch (const alhazen::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return alhazen::exit_bad_input;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "alhazen: out of memory: render fewer pixels or layers at once (--size, --crop), or in float\n");
    return alhazen::exit_failed;
  } catch (const std::exception& error) {
    fmt::print(stderr, "alhazen: {}\n", error.what());
    return alhazen::exit_failed;
  }
}
