#include "study/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <set>

#include "compile/compile_scene.h"
#include "files/atomic_file.h"
#include "files/input_file.h"
#include "pipeline/load_scene.h"
#include "render/checkpoint.h"
#include "render/renderer.h"
#include "study/conclusions.h"
#include "study/disturbance.h"
#include "study/folder.h"
#include "study/json.h"
#include "study/plan.h"
#include "study/write.h"

namespace alhazen::impl::study {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* figure2 = "figure2";
constexpr const char* figure3 = "figure3";

bool is_wanted(const ReportOptions& options, const std::string& part) {
  return options.only.empty() || std::find(options.only.begin(), options.only.end(), part) != options.only.end();
}

std::string json_path(const ReportOptions& options) { return in_folder(options.output, "study.json"); }

void check_options(const ReportOptions& options) {
  const std::vector<std::string> parts = report_parts();
  for (const std::string& part : options.only)
    if (std::find(parts.begin(), parts.end(), part) == parts.end())
      throw InputError(fmt::format("the report has no part '{}': it may be {}", part, fmt::join(parts, ", ")));
  if (options.resume && options.overwrite) throw InputError("give --resume or --overwrite, not both");
  check_folder(options.output, options.resume, options.overwrite);
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

/// Returns whether a cell shows the trial or uses it as baseline.
bool uses(const Table& table, const Trial& trial) {
  return std::any_of(table.cells.begin(), table.cells.end(),
                     [&](const Cell& cell) { return cell.trial == trial.key || cell.baseline == trial.key; });
}

/// Keeps only the requested parts, those that an earlier run has measured, and their trials.
void keep_wanted(const ReportOptions& options, const std::vector<std::string>& earlier, Study& study) {
  std::erase_if(study.tables, [&](const Table& table) {
    return !is_wanted(options, table.id) && std::find(earlier.begin(), earlier.end(), table.id) == earlier.end();
  });
  for (Trial& trial : study.trials)
    trial.is_asked = std::any_of(study.tables.begin(), study.tables.end(), [&](const Table& table) {
      return is_wanted(options, table.id) && uses(table, trial);
    });
  std::erase_if(study.trials, [&](const Trial& trial) {
    return std::none_of(study.tables.begin(), study.tables.end(),
                        [&](const Table& table) { return uses(table, trial); });
  });
}

/// Gives a trial that is measured again the earlier results that have no successor yet.
void restore(const Trial& earlier, Trial& trial) {
  if (trial.status == TrialStatus::not_run && trial.seconds.empty()) trial = earlier;
  const std::vector<bool> repeated = runs_to_repeat(earlier);
  for (size_t i = 0; i < repeated.size() && trial.seconds.size() < repeated.size(); ++i)
    if (repeated[i]) trial.add_run(earlier, i);
}

size_t count_runs(const Study& study) {
  size_t runs = 0;
  for (const Trial& trial : study.trials) runs += trial.seconds.size();
  return runs;
}

class Report {
 public:
  Report(const ReportOptions& options, const ReportEvents& events) : options_(options), events_(events) {
    // The same command again goes on where it was interrupted.
    if (!options.resume && !options.overwrite) options_.resume = holds_incomplete_study(options.output);
  }

  ReportOutcome run() {
    check_options(options_);
    Diagnostics diagnostics;
    LoadedScene loaded = load_scene(options_.scene, {}, diagnostics);
    refuse_inputs(options_.output, *loaded.inputs);
    scene_ = std::move(loaded.scene);
    plan();
    for (const Diagnostics::Warning& warning : diagnostics.warnings()) events_.warning(warning.to_string());
    const bool is_new_folder = create_folder(options_.output);
    check_target(json_path(options_));
    const size_t runs_before = count_runs(study_);
    const bool is_complete = render_images() && measure_trials();
    if (!is_complete && !has_saved_ && count_runs(study_) == runs_before) {
      std::error_code ignored;
      if (is_new_folder) fs::remove(options_.output, ignored);
      return {};
    }
    study_.is_complete = is_complete && (earlier_.is_complete || has_all_runs());
    return {is_complete, write_all()};
  }

 private:
  void plan() {
    study_.date = today();
    study_.machine = this_machine();
    study_.scale = options_.scale;
    study_.scene = facts_of(scene_, options_.scene);
    plan_study(study_);
    renders_figure3_ = is_wanted(options_, figure3);
    if (!options_.resume) return keep_wanted(options_, {}, study_);
    const std::string path = json_path(options_);
    const nlohmann::json earlier = read_study_json(path);
    keep_wanted(options_, tables_of(earlier, path), study_);
    earlier_ = study_;
    for (Trial& trial : earlier_.trials) trial.is_asked = false;
    resume_from(earlier, path, earlier_);
    resume_from(earlier, path, study_);
    study_.is_complete = false;
    events_.stage(fmt::format("continuing the study in {}: {} of {} runs are measured", options_.output,
                              study_.runs_measured(), study_.runs_planned()));
    renders_figure3_ |= earlier.contains("figure3") && !read_figure3();
  }

  /// Reads the work of each thread from the files of an earlier run. Returns false if they are missing or damaged.
  bool read_figure3() {
    WorkPerThread& w = study_.work_per_thread;
    try {
      const Image bounces = read_image(file("figure3-naive.pfm"));
      const bool is_same_size = bounces.width == w.width && bounces.height == w.height && !bounces.planes.empty();
      if (!is_same_size || !input_problem(file("figure3-chunked.pfm")).message.empty()) return false;
      take_bounces(bounces.planes[0]);
      return true;
    } catch (const InputError&) {
      return false;
    }
  }

  void take_bounces(const std::vector<float>& bounces) {
    WorkPerThread& w = study_.work_per_thread;
    const int width = static_cast<int>(w.width), height = static_cast<int>(w.height);
    w.naive = threads_of(bounces, width, height, 1, 1);
    w.chunked = threads_of(bounces, width, height, w.chunks_x, w.chunks_y);
  }

  /// Whether the trials that are only kept from an earlier run were measured completely.
  bool has_all_runs() const {
    return std::none_of(study_.trials.begin(), study_.trials.end(),
                        [&](const Trial& trial) { return !trial.is_asked && trial.lacks_runs(study_.scale.repeats); });
  }

  std::vector<std::string> write_all() {
    const Study study = study_to_save();
    for (const std::string& warning : warnings_of(study)) events_.warning(warning);
    events_.stage("writing tables, plots and the page");
    std::vector<std::string> files =
        write_study(study, options_.output, {events_.go_on, [&] { finish_save(); }, events_.warning});
    if (has_lost_figure_) throw RenderError("the study is written, but some figures could not be: see the warnings");
    return files;
  }

  /// The study with the runs of earlier ones that are not measured again yet.
  Study study_to_save() const {
    Study study = study_;
    for (Trial& trial : study.trials)
      if (const Trial* earlier = earlier_.find(trial.key)) restore(*earlier, trial);
    study.seconds = earlier_.seconds + std::chrono::duration<double>(Clock::now() - start_).count();
    return study;
  }

  /// Called once study.json is written: the folder then holds this study, and no longer the one that it replaces.
  void finish_save() {
    if (has_saved_) return;
    has_saved_ = true;
    if (options_.overwrite) remove_replaced_files(options_.output);
    if (figure2_) has_lost_figure_ |= !attempt([&] { write_png(file("figure2.png"), source_of(*figure2_), {}); });
    if (!has_new_figure3_) return;
    const WorkPerThread& w = study_.work_per_thread;
    for (const auto& [name, threads] : {std::pair{"figure3-naive.pfm", &w.naive}, {"figure3-chunked.pfm", &w.chunked}})
      has_lost_figure_ |=
          !attempt([&] { write_grey_pfm(file(name), threads->width, threads->height, threads->mean_segments); });
  }

  /// Renders Figures 2 and 3 and the reference of the errors, which are not timed.
  bool render_images() {
    if (is_wanted(options_, figure2)) {
      events_.stage("Figure 2: the image");
      Work work;
      work.settings.samples_per_pixel = options_.scale.image_samples;
      std::optional<Outcome> outcome = render_image(work, scene_);
      if (!outcome) return false;
      figure2_ = std::move(outcome->image);
    }
    if (renders_figure3_ && !take_figure3()) return false;
    if (!study_.table("error") || !is_wanted(options_, "error")) return true;
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
    take_bounces(bounces);
    has_new_figure3_ = true;
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
                           attempt([&] {
                             write_json(study_to_save(), options_.output);
                             finish_save();
                           });
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

  std::string file(const char* name) const { return in_folder(options_.output, name); }

  ReportOptions options_;
  const ReportEvents& events_;
  Clock::time_point start_ = Clock::now();
  Scene scene_;
  std::optional<Image> reference_;
  std::optional<Image> figure2_;  ///< written with the study
  Study earlier_;                 ///< what is continued; else empty
  Study study_;
  bool renders_figure3_ = false;
  bool has_new_figure3_ = false;
  bool has_saved_ = false;
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

}  // namespace alhazen::impl::study
