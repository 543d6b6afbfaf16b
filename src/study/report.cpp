#include "study/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <set>

#include "compile/compile_scene.h"
#include "files/atomic_file.h"
#include "pipeline/load_scene.h"
#include "render/checkpoint.h"
#include "render/renderer.h"
#include "study/conclusions.h"
#include "study/json.h"
#include "study/plan.h"
#include "study/write.h"

namespace alhazen::study {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* figure2 = "figure2";
constexpr const char* figure3 = "figure3";

bool is_wanted(const ReportOptions& options, const std::string& part) {
  return options.only.empty() || std::find(options.only.begin(), options.only.end(), part) != options.only.end();
}

std::string json_path(const ReportOptions& options) { return (fs::path(options.output) / "study.json").string(); }

void check_options(const ReportOptions& options) {
  const std::vector<std::string> parts = report_parts();
  for (const std::string& part : options.only)
    if (std::find(parts.begin(), parts.end(), part) == parts.end())
      throw InputError(fmt::format("the report has no part '{}': it may be {}", part, fmt::join(parts, ", ")));
  if (options.resume && options.overwrite) throw InputError("give --resume or --overwrite, not both");
  if (fs::exists(options.output) && !fs::is_directory(options.output))
    throw InputError({options.output}, "this is not a folder: give --output the name of a folder");
  const bool is_there = fs::exists(json_path(options));
  if (is_there && !options.resume && !options.overwrite)
    throw InputError({options.output},
                     "there is a study in this folder: give --resume to continue it, --overwrite to replace it, "
                     "or another --output");
  if (!is_there && options.resume)
    throw InputError({json_path(options)}, "there is no study here to continue: leave out --resume");
}

SceneFacts facts_of(const Scene& scene, const std::string& path) {
  const RenderSettings settings = resolve_settings({}, scene);
  Diagnostics diagnostics;
  const CompiledScene<float> flat =
      compile_scene<float>(Scene(scene), {settings.width, settings.height, 0, {}}, diagnostics);
  SceneFacts facts;
  facts.name = fs::path(path).filename().string();
  facts.hash = fmt::format("{:016x}", scene_fingerprint(flat));
  facts.width = settings.width;
  facts.height = settings.height;
  facts.segments = settings.max_segments;
  facts.spheres = flat.statistics.spheres;
  facts.triangles = flat.statistics.triangles;
  facts.lights = flat.statistics.lights;
  return facts;
}

/// Keeps only the requested parts, and the trials that their cells show or use as baseline.
void keep_wanted(const ReportOptions& options, Study& study) {
  std::erase_if(study.tables, [&](const Table& table) { return !is_wanted(options, table.id); });
  std::erase_if(study.trials, [&](const Trial& trial) {
    for (const Table& table : study.tables)
      for (const Cell& cell : table.cells)
        if (cell.trial == trial.key || cell.baseline == trial.key) return false;
    return true;
  });
}

class Report {
 public:
  Report(const ReportOptions& options, const ReportEvents& events) : options_(options), events_(events) {}

  ReportOutcome run() {
    check_options(options_);
    Diagnostics diagnostics;
    scene_ = load_scene(options_.scene, {}, diagnostics).scene;
    plan();
    for (const Diagnostics::Warning& warning : diagnostics.warnings()) events_.warning(warning.to_string());
    std::error_code error;
    fs::create_directories(options_.output, error);
    if (error) throw InputError({options_.output}, "the folder cannot be made: " + error.message());
    check_target(json_path(options_));
    earlier_seconds_ = study_.seconds;
    study_.is_complete = render_images() && measure_trials();
    save_seconds();
    if (const std::string warning = disturbance_warning(study_); !warning.empty()) events_.warning(warning);
    events_.stage("writing tables, plots and the page");
    std::vector<std::string> files = write_study(study_, options_.output, events_.warning);
    if (has_lost_figure_) throw RenderError("the study is written, but some figures could not be: see the warnings");
    return {study_.is_complete, std::move(files)};
  }

 private:
  void plan() {
    study_.date = today();
    study_.machine = this_machine();
    study_.scale = options_.scale;
    study_.scene = facts_of(scene_, options_.scene);
    plan_study(study_);
    keep_wanted(options_, study_);
    if (options_.resume) resume_from(read_study_json(json_path(options_)), json_path(options_), study_);
  }

  /// Renders Figures 2 and 3 and the reference of the errors, which are not timed.
  bool render_images() {
    if (is_wanted(options_, figure2)) {
      events_.stage("Figure 2: the image");
      Work work;
      work.settings.samples_per_pixel = options_.scale.image_samples;
      const std::optional<Outcome> outcome = render_image(work, scene_);
      if (!outcome) return false;
      has_lost_figure_ |= !attempt([&] { write_png(file("figure2.png"), source_of(*outcome->image), {}); });
    }
    if (is_wanted(options_, figure3) && !take_figure3()) return false;
    if (!study_.table("error")) return true;
    events_.stage("the reference for errors");
    Work work;
    work.settings.integrator = "path";
    work.settings.width = work.settings.height = options_.scale.error_size;
    work.settings.samples_per_pixel = options_.scale.reference_samples;
    work.settings.seed = scene_.seed + 1;
    std::optional<Outcome> outcome = render_image(work, scene_);
    if (outcome) reference_ = std::move(outcome->image);
    return outcome.has_value();
  }

  bool take_figure3() {
    events_.stage("Figure 3: bounces of every thread");
    Work work;
    work.settings.integrator = "iterative";
    work.settings.samples_per_pixel = options_.scale.bounces_samples;
    work.settings.aovs = {"bounces"};
    const std::optional<Outcome> outcome = render_image(work, scene_);
    if (!outcome) return false;
    const Image& image = *outcome->image;
    const std::vector<float>& bounces = image.planes[static_cast<size_t>(image.channel("bounces.Y"))];
    WorkPerThread& w = study_.work_per_thread;
    w.width = image.width;
    w.height = image.height;
    w.samples_per_pixel = outcome->statistics.samples_per_pixel;
    w.statistic_mean = outcome->statistics.mean_segments();
    w.naive = threads_of(bounces, image.width, image.height, 1, 1);
    w.chunked = threads_of(bounces, image.width, image.height, w.chunks_x, w.chunks_y);
    for (const auto& [name, threads] : {std::pair{"figure3-naive.pfm", &w.naive}, {"figure3-chunked.pfm", &w.chunked}})
      has_lost_figure_ |=
          !attempt([&] { write_grey_pfm(file(name), threads->width, threads->height, threads->mean_segments); });
    return true;
  }

  /// Renders an image with all CPU threads; nothing if stopped.
  std::optional<Outcome> render_image(Work work, const Scene& scene) {
    work.settings.backend = study_.machine.processors > 1 ? "openmp" : "serial";
    Outcome outcome = run_work(work, scene, true, events_.go_on);
    if (outcome.status == TrialStatus::not_run) return std::nullopt;
    if (outcome.status != TrialStatus::ok) throw RenderError(outcome.reason);
    return outcome;
  }

  bool measure_trials() {
    MeasureEvents events{events_.go_on, events_.progress, [&] {
                           save_seconds();
                           attempt([&] { write_json(study_, options_.output); });
                         }};
    return measure(study_, scene_, reference_ ? &*reference_ : nullptr, events);
  }

  /// Writes a file while measuring. A failure is reported once, and measuring continues, since that takes longest.
  /// Returns whether the file was written.
  template <class Write>
  bool attempt(const Write& write) {
    try {
      write();
      return true;
    } catch (const RenderError& failure) {
      if (reported_.insert(failure.what()).second) events_.warning(failure.what());
      return false;
    }
  }

  void save_seconds() {
    study_.seconds = earlier_seconds_ + std::chrono::duration<double>(Clock::now() - start_).count();
  }
  std::string file(const char* name) const { return (fs::path(options_.output) / name).string(); }

  const ReportOptions& options_;
  const ReportEvents& events_;
  Clock::time_point start_ = Clock::now();
  double earlier_seconds_ = 0;
  Scene scene_;
  std::optional<Image> reference_;
  Study study_;
  std::set<std::string> reported_;  ///< failures of `attempt` that were reported
  bool has_lost_figure_ = false;
};

}  // namespace

std::vector<std::string> report_parts() {
  Study study;
  study.scale = quick_scale();
  study.scene.width = study.scene.height = 100;
  plan_study(study);
  std::vector<std::string> parts;
  for (const Table& table : study.tables) parts.push_back(table.id);
  parts.insert(parts.end(), {figure2, figure3});
  return parts;
}

ReportOutcome run_report(const ReportOptions& options, const ReportEvents& events) {
  return Report(options, events).run();
}

}  // namespace alhazen::study
