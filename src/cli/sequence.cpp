#include "cli/sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/frames.h"
#include "cli/interrupt.h"
#include "cli/live_options.h"
#include "cli/subcommands.h"
#include "cli/video.h"
#include "images/display/display_bytes.h"
#include "io/read_scene.h"
#include "pipeline/load_scene.h"
#include "render/setting_table.h"
#include "study/tuned.h"
#include "util/printable.h"

namespace alhazen::impl {

namespace {

namespace fs = std::filesystem;

/// What is asked for, checked before anything is read.
struct Plan {
  std::vector<int64_t> frames;
  int64_t step = 1;
  std::vector<FramePattern> images;
  std::vector<std::string> videos;

  std::vector<std::string> paths_of(int64_t frame) const {
    std::vector<std::string> paths;
    for (const FramePattern& pattern : images) paths.push_back(pattern.path_of(frame));
    return paths;
  }
  /// Whether the frame needs no rendering: the files of its images are there. One without a byte is what is left where
  /// a machine lost its power, or was made by `touch`, and holds no image.
  bool has_files_of(int64_t frame) const {
    std::error_code ignored;
    return !images.empty() && std::all_of(images.begin(), images.end(), [&](const FramePattern& pattern) {
      const std::string path = pattern.path_of(frame);
      return pattern.has_number() && fs::is_regular_file(path, ignored) && fs::file_size(path, ignored) > 0;
    });
  }
};

FrameRange range_of(const RenderOptions& o) {
  if (o.turntable == 0) return parse_frame_range(o.frames);
  FrameRange range{0, o.turntable - 1, 1};
  if (o.frames.empty()) return range;
  range = parse_frame_range(o.frames);
  if (range.last >= o.turntable)
    throw InputError(fmt::format("--turntable {} has the frames 0 to {}, and --frames asks for {}", o.turntable,
                                 o.turntable - 1, range.last));
  return range;
}

void refuse_settings(const RenderOptions& o) {
  if (!o.settings.checkpoint.empty() || o.settings.resume)
    throw InputError(
        "--checkpoint and --resume are for one image: a sequence continues with the frames that are missing when the "
        "same command is given again");
  if (o.turntable == 0 && o.settings.animation_time)
    throw InputError("--time is for one image: the frame f of --frames has the time f / fps");
  if (o.output.paths.empty()) throw InputError("frames need names: give -o NAME_####.png, or -o NAME.mp4 for a video");
}

Plan plan_of(const RenderOptions& o) {
  refuse_settings(o);
  const FrameRange range = range_of(o);
  Plan plan{range.numbers(), range.step, {}, {}};
  for (const std::string& path : o.output.paths) {
    if (path == standard_output_name)
      throw InputError("-o - writes one image to standard output: give the frames names, -o NAME_####.png");
    if (is_video(path)) {
      check_video(path);
      plan.videos.push_back(path);
      continue;
    }
    plan.images.emplace_back(path);
    if (!plan.images.back().has_number() && plan.frames.size() > 1)
      throw InputError({path}, fmt::format("{} frames cannot have one name: write #### or %04d where the number of the "
                                           "frame is to be, NAME_####.png",
                                           plan.frames.size()));
  }
  Diagnostics ignored;  // of names that the scene asks for
  for (const int64_t frame : {plan.frames.front(), plan.frames.back()})
    if (!plan.images.empty()) choose_outputs(plan.paths_of(frame), {}, o.scene, ignored);
  return plan;
}

/// Small and quick: by its brightness the exposure of every frame is chosen, so that it does not change from one to the
/// next.
RenderSettings preview_of(const RenderSettings& settings) {
  constexpr int longer_side = 96;
  RenderSettings small = settings;
  const double scale = std::min(1.0, static_cast<double>(longer_side) / std::max(settings.width, settings.height));
  const auto scaled = [&](int size) { return std::max(1, static_cast<int>(std::lround(size * scale))); };
  small.width = scaled(settings.width);
  small.height = scaled(settings.height);
  const auto inside = [&](int value, int size) { return std::clamp(static_cast<int>(value * scale), 0, size); };
  const PixelWindow& window = settings.window;
  small.window = {inside(window.x0, small.width - 1), 0, inside(window.y0, small.height - 1), 0};
  small.window.x1 = std::max(small.window.x0 + 1, inside(window.x1, small.width));
  small.window.y1 = std::max(small.window.y0 + 1, inside(window.y1, small.height));
  small.samples_per_pixel = 16;
  small.asked.noise = 0;
  small.noise_curve.reset();
  small.noise_exposure = ExposureRule::given;
  small.asked.time_limit = 0;
  small.aovs = {};
  small.denoiser.clear();
  small.guiding = GuidingMode::off;
  return small;
}

class Sequence {
 public:
  explicit Sequence(RenderOptions& options)
      : options_(options),
        plan_(plan_of(options)),
        printer_(options.quiet ? ProgressStyle::none : parse_progress_style(options.progress)),
        warnings_(diagnostics_, printer_),
        overwrites_(std::exchange(options.settings.overwrite, false)) {}

  int run() {
    try {
      return run_uninterrupted();
    } catch (const VideoInterrupted& stop) {
      printer_.finish();
      warnings_.show();
      tell("interrupted: {}{}\n", stop.what(), plan_.images.empty() ? "" : "; the frames that are finished are kept");
      return exit_interrupted;
    }
  }

 private:
  int run_uninterrupted() {
    check_videos();
    leave_out_existing();
    if (pending_.empty() && plan_.videos.empty()) return exit_done;
    if (pending_.empty()) check_videos_against_inputs();
    if (pending_.empty() && writes(is_displayed_format)) return write_videos_of_files();
    ActivityPrinter activity(diagnostics_.activity(), printer_);
    events_.progress = [this](const Progress& progress) {
      printer_.show(progress);
      live_->draw();
      return !is_interrupted();
    };
    events_.warned = [this] { warnings_.show(); };
    events_.started = [&](const RenderStatistics& statistics) {
      if (std::exchange(is_started_, true)) return;
      activity.finish();
      watch_interrupts();
      warnings_.show();
      if (options_.verbose) print_start(statistics);
    };
    load();
    live_.emplace(options_, printer_, [this](const std::string& warning) {
      diagnostics_.warn({}, warning);
      warnings_.show();
    });
    size_t index = 0;
    for (const int64_t frame : plan_.frames) {
      const bool is_pending = std::binary_search(pending_.begin(), pending_.end(), frame);
      if (is_interrupted()) return stop();
      if (!is_pending) {
        add_file_to_videos(frame);
        continue;
      }
      check_outputs(frame);
      printer_.begin_frame(frame, ++index, pending_.size());
      const int code = render_frame(frame, index);
      if (code == exit_interrupted) return stop();
      if (code != exit_done) return code;
    }
    return finish_videos();
  }

  void watch_interrupts() {
    if (!std::exchange(watches_interrupts_, true)) catch_interrupts();
  }

  /// No video may replace what it is made of, or what the scene is read from as far as that is known yet.
  void check_videos() {
    for (const std::string& video : plan_.videos) {
      for (const int64_t frame : plan_.frames)
        for (const std::string& path : plan_.paths_of(frame))
          refuse_same_file({video, "the output"}, {{path, "a frame,"}});
      const double asked = video_rate(), kept = playable_rate(video, asked);
      if (kept != asked)
        diagnostics_.warn({video},
                          fmt::format("it plays at {:.6g} frames per second, not at {:.6g}: a GIF has delays of "
                                      "0.02 to 655.35 seconds that all players keep; give --fps, or an .mp4",
                                      kept, asked));
    }
    check_files(plan_.videos, {}, scene_files(), *inputs_);
  }

  void leave_out_existing() {
    // Frames of a video are premultiplied by their alpha, and those that are read back from PNG would not be.
    const bool reads_none = !plan_.videos.empty() && options_.settings.transparent_background;
    for (const int64_t frame : plan_.frames) {
      const bool is_there = !overwrites_ && plan_.has_files_of(frame);
      if (is_there) kept_.push_back(frame);
      if (reads_none || !is_there) pending_.push_back(frame);
    }
    if (kept_.empty() || options_.quiet) return;
    tell("{} of {} frames are there and are left as they are; {}\n", kept_.size(), plan_.frames.size(),
         reads_none ? "they are rendered for the video alone, which is premultiplied by their alpha"
                    : "--overwrite renders them again");
  }

  double seconds_of(int64_t frame) const { return static_cast<double>(frame) / options_.settings.frames_per_second; }

  /// Reads the scene, and the cameras of all frames if nothing but the camera moves.
  void load() {
    Settings settings = options_.settings;
    ReadOptions choice = read_options(settings);  // checks them
    if (options_.turntable > 0) {
      LoadedScene loaded = load_turning_scene(options_.scene, settings, diagnostics_);
      const Camera first = loaded.scene.camera;
      for (const int64_t frame : plan_.frames)
        cameras_.push_back(turned_camera(first, loaded.pivot,
                                         360 * static_cast<double>(frame) / static_cast<double>(options_.turntable)));
      compile(std::move(loaded), settings);
    } else {
      std::vector<double> times;
      for (const int64_t frame : plan_.frames) times.push_back(seconds_of(frame));
      choice.time = 0;
      cameras_ = read_camera_path(options_.scene, choice, times);
      if (!cameras_.empty()) {
        settings.animation_time = 0;
        LoadedScene loaded = load_scene(options_.scene, settings, diagnostics_);
        const Camera first = loaded.scene.camera;
        for (Camera& camera : cameras_) camera = placed_camera(settings, camera, loaded.scene);
        loaded.scene.camera = first;
        compile(std::move(loaded), settings);
      } else if (may_choose_display()) {
        fit_exposure_by_frame_0();
      }
    }
    if (!cameras_.empty() && settings.shutter.value_or(0) > 0)
      diagnostics_.warn({}, "the camera is at rest while the shutter is open: its motion is not blurred");
  }

  template <class Is>
  bool writes(const Is& is) const {
    const std::vector<std::string> paths = plan_.paths_of(plan_.frames.front());
    return std::any_of(paths.begin(), paths.end(), is);
  }
  /// Whether anything is written as displays show it.
  bool has_display() const { return writes(is_displayed_format) || !plan_.videos.empty(); }

  /// Whether the exposure or the white balance may be left to the image, before the scene is known. A noise target may
  /// have the same exposure.
  bool may_choose_display() const {
    const DisplayChoice& choice = options_.output.display;
    return !options_.settings.noise_exposure || (has_display() && choice.estimates_white);
  }

  std::vector<NamedFile> scene_files() const {
    return {{options_.scene == standard_input_name ? "" : options_.scene, "the scene"},
            {options_.settings.environment, "the environment map"}};
  }

  /// No frame may replace a file that the scene is read from.
  void check_outputs(int64_t frame) const {
    std::vector<std::string> paths = writes_files_of(frame) ? plan_.paths_of(frame) : std::vector<std::string>{};
    paths.insert(paths.end(), plan_.videos.begin(), plan_.videos.end());
    check_files(paths, {}, scene_files(), *inputs_);
  }

  bool writes_files_of(int64_t frame) const { return !std::binary_search(kept_.begin(), kept_.end(), frame); }

  /// What must be known of the scene before it is compiled.
  RenderSettings prepare(LoadedScene& loaded, const Settings& settings) {
    inputs_ = loaded.inputs;
    const bool is_first = !std::exchange(is_prepared_, true);
    RenderSettings resolved = study::resolve_with_tuned(settings, loaded.scene, options_.scene, diagnostics_);
    if (!is_first) return resolved;
    RenderOptions described = options_;
    described.output.paths = plan_.paths_of(plan_.frames.front());
    if (!plan_.videos.empty()) described.output.paths.push_back("video.png");  // options for PNG are for videos too
    warn_of_options_without_effect(described, resolved, diagnostics_);
    check_sizes(plan_.paths_of(plan_.frames.front()), resolved.window);
    DisplayChoice& choice = options_.output.display;
    if (loaded.scene.film.fits_exposure && options_.display.exposure.empty()) choice.exposure = ExposureRule::fitting;
    fits_exposure_ = resolved.noise_exposure != ExposureRule::given ||
                     (has_display() && (choice.exposure != ExposureRule::given || choice.estimates_white));
    return resolved;
  }

  /// Every frame has the exposure and white balance that the first frame of the whole turn or animation would get,
  /// frame 0.
  void choose_exposure(SceneRenderer& renderer, const Camera* camera, const RenderSettings& settings) {
    const RenderSettings small = preview_of(settings);
    RenderEvents silent;
    silent.progress = [](const Progress&) { return !is_interrupted(); };
    const Rendering preview = renderer.render(silent, camera, &small);
    if (!preview.has_samples()) return;
    DisplayChoice choice = std::exchange(options_.output.display, {});
    if (choice.exposure == ExposureRule::given) choice.exposure = settings.noise_exposure;
    display_ = choose_display(preview, choice, options_.output.how);
    if (has_display() && !options_.quiet) tell("{}", display_lines(*display_));
  }

  void use_exposure(RenderSettings& settings) const {
    if (!fits_exposure_ || settings.noise_exposure == ExposureRule::given) return;
    settings.noise_curve->scale = portable_exp2(options_.output.how.exposure);
    settings.noise_exposure = ExposureRule::given;
  }

  void compile(LoadedScene loaded, const Settings& settings) {
    settings_ = prepare(loaded, settings);
    const Camera first = loaded.scene.camera;
    renderer_ = make_scene_renderer(std::move(loaded.scene), settings_, loaded.seconds, diagnostics_);
    if (!fits_exposure_) return;
    choose_exposure(*renderer_, &first, settings_);
    use_exposure(settings_);
  }

  /// What the frame is called where it is shown while it is rendered.
  std::string name_of(int64_t frame) const {
    if (!plan_.images.empty()) return plan_.paths_of(frame).front();
    return fmt::format("{} {}", plan_.videos.front(), frame);
  }

  Rendering rendering_of(int64_t frame) {
    events_.watcher = live_->begin(name_of(frame));
    if (renderer_) {
      const auto at = std::lower_bound(plan_.frames.begin(), plan_.frames.end(), frame) - plan_.frames.begin();
      return renderer_->render(events_, &cameras_[static_cast<size_t>(at)]);
    }
    Settings settings = options_.settings;
    settings.animation_time = seconds_of(frame);
    LoadedScene loaded = load_scene(options_.scene, settings, diagnostics_);
    settings_ = prepare(loaded, settings);
    use_exposure(settings_);
    check_outputs(frame);
    return render_scene(std::move(loaded.scene), settings_, loaded.seconds, events_, diagnostics_);
  }

  void fit_exposure_by_frame_0() {
    Settings settings = options_.settings;
    settings.animation_time = 0;
    LoadedScene loaded = load_scene(options_.scene, settings, diagnostics_);
    const RenderSettings resolved = prepare(loaded, settings);
    if (!fits_exposure_) return;
    const RenderSettings small = preview_of(resolved);
    const Camera camera = loaded.scene.camera;
    choose_exposure(*make_scene_renderer(std::move(loaded.scene), small, 0, diagnostics_), &camera, resolved);
  }

  int render_frame(int64_t frame, size_t index) {
    Rendering rendering = rendering_of(frame);
    live_->finish(rendering);
    printer_.finish();
    warnings_.show();
    const RenderStatistics& statistics = rendering.statistics;
    // A frame with fewer samples than the others would be taken for a finished one.
    if (is_interrupted() && !statistics.complete) return exit_interrupted;
    if (!rendering.has_samples()) {
      tell("alhazen: the time limit passed before the first sample of frame {}: no image is written\n", frame);
      return exit_failed;
    }
    OutputOptions output = options_.output;
    output.paths = plan_.paths_of(frame);
    if (has_display())
      rendering.statistics.display = display_ ? *display_ : choose_display(rendering, output.display, output.how);
    const OutputReport report = writes_files_of(frame) ? write_outputs(output, rendering) : OutputReport{};
    print_end(options_, report, statistics, fmt::format("frame {} ({} of {}): ", frame, index, pending_.size()), frame);
    if (!report.failures.empty()) return exit_failed;
    if (!plan_.videos.empty())
      add_to_videos(rendering.source().width, rendering.source().height,
                    display_bytes(plan_.videos[0], rendering.source(), options_.output.how));
    return exit_done;
  }

  // Videos ------------------------------------------------------------------------------------------------------------

  double video_rate() const { return options_.settings.frames_per_second / static_cast<double>(plan_.step); }

  void add_to_videos(int width, int height, const std::vector<uint8_t>& bytes) {
    watch_interrupts();  // ffmpeg runs from now on
    if (videos_.empty())
      for (const std::string& path : plan_.videos)
        videos_.push_back(std::make_unique<VideoWriter>(path, width, height, video_rate()));
    for (const auto& video : videos_) {
      if (video->width() != width || video->height() != height)
        throw InputError(
            fmt::format("the frames of a video have one size: one has {} x {} pixels, and those before it "
                        "{} x {}; render those again with --overwrite",
                        width, height, video->width(), video->height()));
      video->add(bytes);
    }
    ++frames_of_videos_;
  }

  /// A frame that is there already: of its PNG or JPEG as it is, else of another file as that would be written.
  void add_file_to_videos(int64_t frame) {
    if (plan_.videos.empty()) return;
    std::vector<std::string> paths = plan_.paths_of(frame);
    std::stable_partition(paths.begin(), paths.end(), is_displayed_format);
    std::stable_partition(paths.begin(), paths.end(),
                          [](const std::string& path) { return extension_of(path) == "png"; });
    const std::string& path = paths[0];
    const Image image = read_image(path);
    add_to_videos(
        image.width, image.height,
        display_bytes(path, source_of(image), is_displayed_format(path) ? WriteOptions{} : options_.output.how));
  }

  /// The files that the scene names are known when it is read, which is needed only if a video is there already.
  void check_videos_against_inputs() {
    std::error_code ignored;
    const auto exists = [&](const std::string& path) { return fs::exists(path, ignored); };
    if (std::none_of(plan_.videos.begin(), plan_.videos.end(), exists)) return;
    Diagnostics unsaid;  // nothing is rendered
    Settings settings = options_.settings;
    if (options_.turntable == 0) settings.animation_time = seconds_of(plan_.frames.front());
    inputs_ = load_scene(options_.scene, settings, unsaid).inputs;
    check_files(plan_.videos, {}, scene_files(), *inputs_);
  }

  int write_videos_of_files() {
    warnings_.show();
    for (const int64_t frame : plan_.frames) {
      if (is_interrupted()) return stop();
      add_file_to_videos(frame);
    }
    return finish_videos();
  }

  int finish_videos() {
    for (size_t i = 0; i < videos_.size(); ++i) {
      videos_[i]->finish();
      if (!options_.quiet) tell("wrote {} of {} frames\n", printable(plan_.videos[i]), frames_of_videos_);
    }
    return exit_done;
  }

  int stop() {
    printer_.finish();
    warnings_.show();
    const bool has_images = !plan_.images.empty();
    if (!has_images) finish_videos();  // else they are made when all frames are there
    tell("interrupted: {}\n", pending_.empty() ? "no video is written; the same command makes it again"
                              : has_images
                                  ? "the frames that are finished are kept; the same command renders the others"
                              : videos_.empty() ? "no frame is finished, and no video is written"
                                                : "the video has the frames so far; the same command begins again");
    return exit_interrupted;
  }

  RenderOptions& options_;
  Plan plan_;
  std::vector<int64_t> pending_;  ///< frames to render
  std::vector<int64_t> kept_;     ///< frames whose files are left as they are
  Diagnostics diagnostics_;
  ProgressPrinter printer_;
  WarningPrinter warnings_;
  bool overwrites_;
  RenderEvents events_;
  std::optional<LiveRender> live_;
  RenderSettings settings_;
  std::shared_ptr<InputRecord> inputs_ = std::make_shared<InputRecord>();  ///< of the last scene that was read
  std::vector<Camera> cameras_;              ///< of plan_.frames; empty: each frame reads the scene
  std::unique_ptr<SceneRenderer> renderer_;  ///< if there are cameras; refers to settings_
  bool is_started_ = false, is_prepared_ = false, watches_interrupts_ = false;
  bool fits_exposure_ = false;                ///< the first frame decides how all are displayed
  std::optional<DisplayStatistics> display_;  ///< by the first frame
  std::vector<std::unique_ptr<VideoWriter>> videos_;
  size_t frames_of_videos_ = 0;
};

}  // namespace

int render_sequence(RenderOptions& options) { return Sequence(options).run(); }

}  // namespace alhazen::impl
