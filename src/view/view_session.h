#pragma once

// A scene that is rendered for pages: coarse at once, then ever finer, anew after each change that a page asks for.
// One camera, and all else, is common to all pages. A thread renders, whether or not a page is connected; another sends
// pictures (Viewers); those of the server only leave what they are told (Mailbox).

#include <array>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "alhazen/renderer.h"
#include "alhazen/scene.h"
#include "view/mailbox.h"
#include "view/noise_curve.h"
#include "view/page_server.h"
#include "view/pick_desk.h"
#include "view/protocol.h"
#include "view/scene_edit.h"
#include "view/view_failure.h"
#include "view/view_renderer.h"
#include "view/viewers.h"

namespace alhazen::impl {

struct ViewOptions {
  std::string scene;  ///< file
  LoadOptions load;
  Settings settings;                               ///< nothing about reading
  std::vector<std::string> cameras;                ///< names of those in the file
  std::optional<std::array<double, 2>> animation;  ///< seconds from, to
  double exposure = 0;                             ///< stops, that pages begin with
  std::string tone_map = "none";
  std::string options;  ///< of the command line, for a page to repeat them in commands
  /// Told of warnings, and of the error that ends all, as lines without a line feed; by the thread that renders.
  std::function<void(const std::string&)> report = [](const std::string&) {};
};

class ViewSession {
 public:
  ViewSession(ViewOptions options, ViewerSender& sender);
  ~ViewSession();
  ViewSession(const ViewSession&) = delete;
  ViewSession& operator=(const ViewSession&) = delete;

  /// What a PageServer is to be given. The session must outlive it.
  PageEvents events();
  /// Begins to read the scene.
  void start();
  /// Ends the render. Nothing is sent any more when it returns.
  void stop();
  ViewFailure failure() const;

 private:
  // On threads of the server.
  void handle_message(ViewerId viewer, std::string_view text);
  void handle(ViewerId viewer, const PageMessage& message);
  void greet(ViewerId viewer);
  void want_layers(ViewerId viewer, const LayersMessage& message);
  PageResponse get(const std::string& path, const std::string& query) const;

  // On that of picks.
  void pick(ViewerId viewer, const PickMessage& message);

  // On the thread that renders.
  void run();
  void load();
  void render();
  void render_next();
  void render_coarse();
  void start_image();
  void render_pass();
  void denoise();
  void apply(Mail& mail);
  template <class Change>
  void apply_for(ViewerId viewer, const Change& change);
  void move_camera(const From<CameraRequest>& request);
  void change_material(const MaterialMessage& message);
  ::alhazen::Camera file_camera(size_t index);
  void begin_view();
  void begin_image();
  void show(ViewImage&& image);
  void fail(const std::string& message, ViewFailure failure);
  void tell_scene();
  void tell_camera(ViewerId by);
  void tell_warnings();
  void tell_new(const std::vector<Warning>& warnings);
  std::set<std::string> missing_layers() const;
  std::set<std::string> rendered_layers() const;
  ProgressFunction building();

  // On any.
  void change_status(const std::function<void(StatusText&)>& change);

  ViewOptions options_;
  Mailbox mailbox_;
  Viewers viewers_;

  // Of the thread that renders, and with `scene_mutex_` of that of picks.
  std::mutex scene_mutex_;
  std::unique_ptr<ViewRenderer> renderer_;
  MaterialChanges changes_;
  Picker picker_;  ///< of picks alone

  // Of the thread that renders.
  SceneExtent extent_;
  uint64_t picture_number_ = 0, view_ = 0;
  std::optional<ViewOrigin> origin_;  ///< of the view
  std::optional<PageCamera> placed_;  ///< where a page has placed the camera
  int step_ = 0;                      ///< of the next coarse picture; 0: the image itself
  bool is_first_of_view_ = false;     ///< whether the view has no picture yet
  bool is_started_ = false;           ///< the image
  bool is_denoised_ = false;          ///< the image, or it cannot be
  bool is_idle_ = false;              ///< after a failure, until something changes
  NoiseCurve curve_;
  std::vector<Warning> told_warnings_;
  std::set<std::string> refused_layers_;  ///< that this scene cannot be rendered with

  mutable std::mutex mutex_;  ///< of what follows
  StatusText status_;
  bool is_at_rest_ = false;  ///< no pass is taken: what the image reports of its progress is not news
  std::optional<SceneText> scene_text_;
  std::string fatal_error_, changes_text_;
  ViewFailure failure_ = ViewFailure::none;
  std::vector<std::string> logs_;
  std::set<std::string> layers_;            ///< that are rendered
  std::shared_ptr<const ViewImage> image_;  ///< the last at full resolution

  PickDesk desk_{[this](ViewerId viewer, const PickMessage& message) { pick(viewer, message); }};
  std::thread thread_;
};

}  // namespace alhazen::impl
