#pragma once

// Renders one scene for viewers: coarse pictures in a moment, then the image itself, pass by pass. Used by one thread.

#include <array>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "alhazen/renderer.h"
#include "alhazen/scene.h"
#include "view/mailbox.h"
#include "view/picture.h"
#include "view/view_camera.h"

namespace alhazen::impl {

/// Layers that pages may ask for and that images are rendered with then, with their channels.
const std::vector<std::pair<std::string, std::vector<std::string>>>& view_layers();

/// A picture and what files of it say.
struct ViewImage {
  std::shared_ptr<Picture> picture;
  RenderedImage description;  ///< without channels and planes
};

class ViewRenderer {
 public:
  static constexpr int max_step = 16;

  /// Of the settings, those that place the camera are applied to the scene; without a size the film's is taken, scaled
  /// down to a longer side of 1280 pixels at most. Other threads may read the scene while they hold `scene_mutex`,
  /// which is not held during passes.
  ViewRenderer(::alhazen::Scene scene, const Settings& settings, Mailbox& mailbox, std::mutex& scene_mutex);

  // What is rendered. After a change of it, an image that is under way must not be continued. ------------------------

  ::alhazen::Scene& scene() { return scene_; }
  /// As the scene is now, and as it was at first.
  ::alhazen::Camera camera() const { return scene_.camera(); }
  const ::alhazen::Camera& first_camera() const { return first_camera_; }
  void set_camera(const ::alhazen::Camera& camera) { scene_.set_camera(camera); }
  const Settings& settings() const { return settings_; }
  int width() const { return static_cast<int>(settings_.width); }
  int height() const { return static_cast<int>(settings_.height); }
  void set_size(int width, int height);
  void set_samples(int64_t samples);
  void set_environment(const EnvironmentMessage& environment);
  /// Whether the image can be denoised at its end.
  void set_denoising(bool on) { settings_.denoiser = on ? "auto" : "none"; }
  /// Those of view_layers that are to be rendered.
  void set_layers(const std::set<std::string>& layers);
  bool renders(const std::string& layer) const { return layers_.contains(layer); }

  // Pictures. All throw what Renderer throws.
  // ---------------------------------------------------------------------------

  /// For the first picture of a view: a power of two such that it is there in about 50 ms, as far as is known.
  int suitable_step() const;
  /// One sample for each square of step x step pixels. Nothing if it was interrupted.
  std::optional<ViewImage> render_coarse(int step, bool is_interruptible, const ProgressFunction& progress);

  /// The image itself.
  void start(const ProgressFunction& progress);
  /// Takes a pass that lasts about so long, at least 4 samples. False if it was interrupted.
  bool render_pass(double seconds);
  bool is_done() const { return is_done_; }
  ViewImage image() const;
  /// The image denoised, after its last pass: a picture with the layer "denoised" alone, or without any if there is no
  /// denoiser. Nothing but another start may follow.
  ViewImage denoised();
  Progress progress() const { return renderer_.progress(); }
  std::vector<Warning> warnings() const { return renderer_.warnings(); }
  int64_t samples() const;  ///< that the image has at its end, as far as is known before it starts

 private:
  PixelRegion region() const;
  Settings coarse_settings(int step) const;
  void start_coarse(int step, const PixelRegion& whole, const ProgressFunction& progress);

  ::alhazen::Scene scene_;
  Settings settings_;  ///< of the image; with a size
  Mailbox& mailbox_;
  std::mutex& scene_mutex_;
  Renderer renderer_;
  ::alhazen::Camera first_camera_;
  std::optional<std::array<int64_t, 4>> first_bounds_;  ///< those of pixels at the first size
  int64_t first_width_ = 0, first_height_ = 0;
  std::set<std::string> layers_;
  bool is_built_ = false, is_done_ = false;
  bool names_parts_ = true;        ///< whether what is built has names for the layers object and material
  double start_seconds_ = 0;       ///< that a coarse picture takes beside its pass
  double seconds_per_pixel_ = 0;   ///< of one sample; 0: not known yet
  double seconds_per_sample_ = 0;  ///< of all pixels of the image; 0: not known yet
};

}  // namespace alhazen::impl
