// `alhazen study tune`: finds the fastest engine for a scene on this machine.

#include <fmt/format.h>

#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/interrupt.h"
#include "cli/progress.h"
#include "cli/setting_options.h"
#include "cli/subcommands.h"
#include "pipeline/load_scene.h"
#include "render/settings.h"
#include "study/machine.h"
#include "study/tune.h"
#include "study/tuned.h"
#include "util/printable.h"

namespace alhazen::impl {

namespace {

struct TuneOptions {
  std::string scene;
  Settings settings;
  double budget = 60;
  bool store = false, store_default = false, quiet = false;
};

/// The options of `alhazen render` for that engine.
std::string engine_options(const Settings& s) {
  study::Work work;
  work.settings = s;
  work.settings.width = work.settings.height = work.settings.samples_per_pixel = 0;
  if (s.precision == "float") work.settings.precision.clear();
  return study::command_options(work);
}

void print_outcome(const TuneOptions& o, const study::TuneOutcome& outcome) {
  constexpr size_t shown = 8;
  print_out("{:<78} {:>10}\n", "engine", "ns/sample");
  for (size_t i = 0; i < outcome.candidates.size() && i < shown; ++i) {
    const study::Candidate& c = outcome.candidates[i];
    if (c.problem.empty() && c.rounds > 0)
      print_out("{:<78} {:>10.1f}{}\n", engine_options(c.work.settings), c.cost(), c.is_default ? "  (auto)" : "");
  }
  const study::Candidate& winner = outcome.candidates[outcome.winner];
  print_out("\nalhazen render {} {}\n", printable(o.scene), engine_options(winner.work.settings));
}

void store(const TuneOptions& o, const study::TuneOutcome& outcome, const std::string& integrator) {
  const study::Candidate& winner = outcome.candidates[outcome.winner];
  study::TunedEntry entry;
  entry.machine = study::machine_key();
  entry.scene = o.store_default ? study::any_scene : study::scene_key(o.scene);
  entry.precision = o.settings.precision;
  entry.integrator = integrator;
  entry.scene_name = o.scene.substr(o.scene.find_last_of('/') + 1);
  entry.version = version();
  entry.date = study::today();
  entry.nanoseconds_per_sample = winner.cost();
  entry.engine = winner.work.settings;
  study::store_tuned(study::tuned_path(), entry);
  if (!o.quiet)
    tell("stored in {}: --backend auto uses it for {}\n", printable(study::tuned_path()),
         o.store_default ? "every scene that has no entry of its own" : "this scene");
}

int run(TuneOptions& o) {
  if (o.store && o.store_default) throw InputError("give --store or --store-default, not both");
  if (o.store || o.store_default) study::check_tuned_target(study::tuned_path());  // before the budget is spent
  Diagnostics diagnostics;
  const Scene scene = load_scene(o.scene, o.settings, diagnostics).scene;
  const RenderSettings settings = resolve_settings(o.settings, scene);
  for (const Diagnostics::Warning& warning : diagnostics.warnings()) tell("warning: {}\n", warning.to_string());
  study::TuneEvents events;
  events.go_on = [] { return !is_interrupted(); };
  events.round = [&](int round, size_t candidates, int64_t samples) {
    if (!o.quiet) tell("round {}: {} engines, {} samples per pixel\n", round, candidates, samples);
  };
  catch_interrupts();
  const study::TuneOutcome outcome = study::tune(scene, o.settings, o.budget, events);
  const bool has_costs = outcome.candidates[outcome.winner].rounds > 0;
  if (!o.quiet && has_costs)
    tell("images of {} x {} pixels, {} in all{}\n", outcome.width, outcome.height, format_seconds(outcome.seconds),
         outcome.is_complete ? "" : "; ended before two engines were left: a larger --budget is more reliable");
  if (has_costs) print_outcome(o, outcome);
  if (is_interrupted()) {
    tell("interrupted: nothing is stored\n");
    return exit_interrupted;
  }
  if (!o.store && !o.store_default) return exit_done;
  if (const std::string reason = study::why_not_to_store(outcome); !reason.empty()) {
    tell("nothing is stored: {}\n", printable(reason));
    return exit_failed;
  }
  store(o, outcome, to_string(settings.integrator));
  return exit_done;
}

}  // namespace

void register_study_tune(Command& study, int& exit_code) {
  Command command = study.add_subcommand("tune", "Find the fastest engine for a scene on this machine");
  auto o = std::make_shared<TuneOptions>();
  command.add_option("SCENE", o->scene, "Scene (.pbrt, .gltf, .glb, .xml) or model (.obj, .ply, .stl)")
      .required()
      .value_name("");
  command.add_option("--budget", o->budget, "Time to spend (60)").within(1.0, 1e6).value_name("SECONDS");
  command.add_flag("--store", o->store, "Store the result, for --backend auto and this scene");
  command.add_flag("--store-default", o->store_default, "Store it for every scene that has no entry of its own");
  for (const char* name : {"precision", "integrator", "max-depth"}) add_setting_option(command, o->settings, name);
  command.add_flag("-q,--quiet", o->quiet, "Print only the result, warnings and errors");
  command.on_run([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace alhazen::impl
