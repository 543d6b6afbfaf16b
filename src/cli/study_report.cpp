// `alhazen study report`: measures every table and figure of the report on this machine.

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <memory>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/interrupt.h"
#include "cli/progress.h"
#include "cli/subcommands.h"
#include "scene/limits.h"
#include "study/report.h"
#include "util/diagnostics.h"
#include "util/printable.h"

namespace alhazen::impl {

namespace {

namespace fs = std::filesystem;

struct StudyReportOptions {
  study::ReportOptions report;
  bool quick = false, full = false, quiet = false;
  int repeats = 0;
  int64_t samples = 0, size = 0;
};

/// scenes/spheres.pbrt in the repository of the build, or where the program was installed.
std::string find_spheres() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  std::vector<fs::path> folders{"."};
  for (fs::path folder = program.parent_path(); folder.has_relative_path(); folder = folder.parent_path())
    folders.insert(folders.end(), {folder, folder / "share/alhazen"});
  for (const fs::path& folder : folders)
    if (const fs::path scene = folder / "scenes/spheres.pbrt"; fs::is_regular_file(scene, error))
      return scene.lexically_normal().string();
  throw InputError("scenes/spheres.pbrt, the report's scene, is not here: name a scene with --scene FILE");
}

void choose_scale(StudyReportOptions& o) {
  if (o.quick && o.full) throw InputError("give --quick or --full, not both");
  study::Scale& scale = o.report.scale;
  scale = o.quick ? study::quick_scale() : o.full ? study::full_scale() : study::default_scale();
  if (o.repeats > 0) scale.repeats = o.repeats;
  if (o.samples > 0) scale.samples = o.samples;
  if (o.size > 0) scale.width = scale.height = o.size;
  if (o.repeats > 0 || o.samples > 0 || o.size > 0) scale.name += ", changed";
}

/// Progress on stderr: a line that is overwritten on a terminal, elsewhere one every few seconds.
class ReportPrinter {
 public:
  explicit ReportPrinter(bool quiet) : quiet_(quiet), is_terminal_(isatty(STDERR_FILENO) != 0) {}

  void show(const study::Measuring& now) {
    const bool is_due = is_terminal_ || last_ < 0 || now.seconds - last_ >= 10;
    if (quiet_ || !is_due) return;
    last_ = now.seconds;
    const std::string left = now.seconds_left >= 0 ? ", about " + format_seconds(now.seconds_left) + " left" : "";
    const std::string line =
        fmt::format("round {} of {}: {} of {} runs{}: {}", std::min(now.round, now.rounds), now.rounds, now.done,
                    now.total, left, now.round > now.rounds ? now.cell + ", again" : now.cell);
    tell_progress(is_terminal_ ? fmt::format("\r{:.110}\x1b[K", line) : line + "\n");
    is_open_ = is_terminal_;
  }

  void say(const std::string& line) {
    if (!quiet_) tell(line);
  }

  void tell(const std::string& line) {
    impl::tell("{}{}\n", is_open_ ? "\n" : "", line);
    is_open_ = false;
  }

 private:
  bool quiet_, is_terminal_, is_open_ = false;
  double last_ = -1;
};

int run(StudyReportOptions& o) {
  choose_scale(o);
  if (o.report.scene.empty()) o.report.scene = find_spheres();
  ReportPrinter printer(o.quiet);
  study::ReportEvents events;
  events.go_on = [] { return !is_interrupted(); };
  events.stage = [&](const std::string& line) { printer.say(line); };
  events.progress = [&](const study::Measuring& now) { printer.show(now); };
  events.warning = [&](const std::string& line) { printer.tell("warning: " + line); };
  catch_interrupts();
  const study::ReportOutcome outcome = study::run_report(o.report, events);
  if (outcome.files.empty()) {
    printer.tell("interrupted before the first measurement: nothing is written");
    return exit_interrupted;
  }
  std::string files;
  for (const std::string& file : outcome.files) files += (files.empty() ? "" : ", ") + file;
  printer.say(fmt::format("wrote {}: {}", printable(o.report.output), files));
  if (outcome.is_complete && !is_interrupted()) return exit_done;
  if (outcome.is_complete)
    printer.tell("interrupted, but the measurements are complete: the same command with --resume draws missing plots");
  else
    printer.tell("interrupted: the measurements so far are written; the same command with --resume continues");
  return exit_interrupted;
}

}  // namespace

void register_study_report(Command& study, int& exit_code) {
  Command command = study.add_subcommand("report", "Run the report's experiments and more; write tables and a page");
  auto o = std::make_shared<StudyReportOptions>();
  command.add_option("-o,--output", o->report.output, "Folder to write to (study)").value_name("DIR");
  command.add_option("--scene", o->report.scene, "A scene other than the report's").value_name("FILE");
  command.add_flag("--quick", o->quick, "Takes about 3 minutes on 2 cores; without it about 15");
  command.add_flag("--full", o->full, "S = 1,000 and the scene's own size, as in the report: hours");
  command.add_option("--repeats", o->repeats, "Runs of each cell").within(1, 1000).value_name("N");
  std::string parts;
  for (const std::string& part : study::report_parts()) parts += (parts.empty() ? "" : ", ") + part;
  command.add_option("--only", o->report.only, "Only these parts, separated by commas: " + parts)
      .separated_by(',')
      .repeatable()
      .value_name("PARTS");
  command.add_option("--size", o->size, "Edge of the square images for timing the CPU, pixels")
      .within(1, 10000)
      .value_name("N");
  command.add_option("--spp", o->samples, "S of the images for timing the CPU")
      .within<int64_t>(1, max_samples_per_pixel)
      .value_name("S");
  command.add_flag("--resume", o->report.resume, "Continue the study in the folder");
  command.add_flag("--overwrite", o->report.overwrite, "Replace the study in the folder");
  command.add_flag("-q,--quiet", o->quiet, "Print only warnings and errors");
  command.on_run([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace alhazen::impl
