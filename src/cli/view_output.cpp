#include "cli/view_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <utility>

#include "cli/rewritten_outputs.h"
#include "images/display/tone_map.h"
#include "view/live_feed.h"

namespace alhazen::impl {

namespace {

PageServerOptions server_options(int port) {
  PageServerOptions options;
  options.port = port;
  return options;
}

class LiveView final : public ViewOutput {
 public:
  explicit LiveView(ViewOutputOptions options)
      : options_(std::move(options)),
        feed_(server_options(options_.port), {options_.stop, [this] { is_save_wanted_ = true; }}) {}

  std::string url() const override { return feed_.url(); }
  void report(const Progress& progress) override { feed_.report(progress); }
  void say(const std::string& warning) override { feed_.say(warning); }

  void begin(const std::string& name) override {
    name_ = name;
    has_begun_ = false;
  }

  bool wants_look() override { return is_save_wanted_ || !feed_.wanted_layers().empty(); }
  bool is_urgent() override { return is_save_wanted_ || feed_.is_waited_for(); }
  /// So that a page that is opened has a picture soon.
  double max_pass_seconds() override { return 1; }

  void look(const Rendering& so_far) override {
    if (is_save_wanted_.exchange(false)) save(so_far);
    if (!feed_.wanted_layers().empty()) show(so_far, false);
  }

  double take_other_seconds() override { return feed_.take_seconds(); }

  void finish(const Rendering& rendering) override {
    if (feed_.wanted_layers().empty()) return;
    show(rendering, true);
    feed_.flush(2);
  }

 private:
  void save(const Rendering& so_far) {
    OutputOptions now = options_.outputs;
    std::erase_if(now.paths, [](const std::string& path) { return !can_be_rewritten(path); });
    if (now.paths.empty())
      return feed_.say("nothing is written before the end: frames, pipes and devices get finished images");
    if (std::any_of(now.paths.begin(), now.paths.end(), is_displayed_format))
      choose_display(so_far, now.display, now.how);
    const OutputReport report = write_outputs(now, so_far);
    for (const std::string& failure : report.failures) feed_.say(failure);
    for (const std::string& path : report.written)
      feed_.say(fmt::format("wrote {} with {:.4g} samples per pixel", path, so_far.statistics.mean_samples));
  }

  void show(const Rendering& rendering, bool is_final) {
    const ImageSource source = rendering.source();
    if (!std::exchange(has_begun_, true)) feed_.begin(scene_text(rendering, source));
    const RenderStatistics& statistics = rendering.statistics;
    const RenderSettings& settings = statistics.settings;
    RenderedImage image;
    image.width = source.width;
    image.height = source.height;
    image.x = settings.window.x0;
    image.y = settings.window.y0;
    image.full_width = settings.width;
    image.full_height = settings.height;
    image.samples = statistics.mean_samples;
    image.seconds = statistics.render_seconds;
    image.complete = is_final;
    image.denoiser = statistics.denoiser;
    image.metadata = image_metadata(rendering, false);
    ViewImage view{nullptr, image};
    // The colours always, by which the noise is estimated.
    Image shown = image_of(source, [layers = feed_.wanted_layers()](const std::string& channel) {
      const std::string layer = layer_of(channel);
      return layer == "color" || layers.contains(layer);
    });
    image.channels = std::move(shown.channels);
    image.planes = std::move(shown.planes);
    view.picture = make_picture(std::move(image));
    feed_.show(view);
  }

  SceneText scene_text(const Rendering& rendering, const ImageSource& source) const {
    const RenderSettings& settings = rendering.statistics.settings;
    SceneText text;
    text.name = name_;
    text.width = settings.width;
    text.height = settings.height;
    text.up = {0, 1, 0};
    for (const std::string& channel : source.channels) {
      const std::string layer = layer_of(channel);
      if (text.layers.empty() || text.layers.back().first != layer) text.layers.push_back({layer, {}});
      text.layers.back().second.push_back(channel);
    }
    text.samples = settings.samples_per_pixel;
    WriteOptions how = options_.outputs.how;
    choose_display(rendering, options_.outputs.display, how);
    text.exposure = how.exposure;
    text.tone_map = to_string(how.tone_map);
    return text;
  }

  ViewOutputOptions options_;
  std::atomic<bool> is_save_wanted_{false};
  std::string name_;
  bool has_begun_ = false;
  LiveFeed feed_;  ///< the last member: its threads use the others
};

}  // namespace

std::unique_ptr<ViewOutput> make_view_output(ViewOutputOptions options) {
  return std::make_unique<LiveView>(std::move(options));
}

}  // namespace alhazen::impl
