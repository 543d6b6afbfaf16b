#include "view/view_session.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "util/diagnostics.h"
#include "util/quoted.h"
#include "util/thread_limit.h"
#include "view/overloaded.h"
#include "view/save_picture.h"

namespace alhazen::impl {

namespace {

/// A camera that moves and sends no more is taken to be at rest after this time.
constexpr std::chrono::milliseconds rest_time{250};

}  // namespace

ViewSession::ViewSession(ViewOptions options, ViewerSender& sender) : options_(std::move(options)), viewers_(sender) {}

ViewSession::~ViewSession() { stop(); }

void ViewSession::start() {
  thread_ = start_thread("the thread that renders for pages", [this] { run(); });
}

void ViewSession::stop() {
  mailbox_.end();
  desk_.end();
  if (thread_.joinable()) thread_.join();
}

PageEvents ViewSession::events() {
  PageEvents events;
  events.opened = [this](ViewerId viewer) {
    viewers_.open(viewer);
    change_status([](StatusText&) {});
  };
  events.message = [this](ViewerId viewer, std::string_view text) { handle_message(viewer, text); };
  events.closed = [this](ViewerId viewer) {
    viewers_.close(viewer);
    mailbox_.leave(viewer);
    change_status([](StatusText&) {});
  };
  events.get = [this](const std::string& path, const std::string& query) { return get(path, query); };
  return events;
}

// On threads of the server. -------------------------------------------------------------------------------------------

void ViewSession::handle_message(ViewerId viewer, std::string_view text) {
  try {
    handle(viewer, parse_page_message(text));
  } catch (...) {
    viewers_.tell(viewer, error_message(text_of_error(), false));
  }
}

void ViewSession::handle(ViewerId viewer, const PageMessage& message) {
  std::visit(Overloaded{
                 [&](const HelloMessage&) { greet(viewer); },
                 [&](const LayersMessage& m) { want_layers(viewer, m); },
                 [&](const AckMessage& m) { viewers_.acknowledge(viewer, m.frame); },
                 [&](const CameraMessage& m) {
                   mailbox_.post(viewer, CameraRequest(m));
                   viewers_.set_camera(camera_message(m.camera, {}), viewer);
                 },
                 [&](const ResetMessage& m) { mailbox_.post(viewer, CameraRequest(m)); },
                 [&](const SelectCameraMessage& m) {
                   if (m.camera >= options_.cameras.size())
                     throw InputError("select_camera: the file has " + std::to_string(options_.cameras.size()) +
                                      " cameras to choose from, numbered from 0");
                   mailbox_.post(viewer, CameraRequest(m));
                 },
                 [&](const PauseMessage& m) { mailbox_.pause(m.paused); },
                 [&](const DenoiseMessage& m) { mailbox_.denoise(m.on); },
                 [&](const StopMessage&) { throw InputError("stop: only the view of a render has this message"); },
                 [&](const SaveMessage&) { throw InputError("save: only the view of a render has this message"); },
                 [&](const PickMessage& m) { desk_.ask(viewer, m); },
                 [&](const TimeMessage&) { throw InputError("time: the time cannot be changed here"); },
                 [&](const auto& m) { mailbox_.post(viewer, m); },
             },
             message);
}

void ViewSession::greet(ViewerId viewer) {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> greetings;
  if (scene_text_) greetings.push_back(scene_message(*scene_text_));
  for (const std::string& log : logs_) greetings.push_back(log_message(log));
  if (!changes_text_.empty()) greetings.push_back(changes_text_);
  if (!fatal_error_.empty()) greetings.push_back(error_message(fatal_error_, true));
  viewers_.welcome(viewer, greetings);
}

void ViewSession::want_layers(ViewerId viewer, const LayersMessage& message) {
  bool is_missing = false;
  {
    const std::lock_guard lock(mutex_);
    for (const std::string& layer : message.layers) {
      if (layer == "color" || layer == "denoised") continue;
      const auto& known = view_layers();
      if (std::none_of(known.begin(), known.end(), [&](const auto& entry) { return entry.first == layer; }))
        throw InputError("layers: there is no layer " + quoted(layer));
      is_missing = is_missing || !layers_.contains(layer);
    }
    viewers_.want(viewer, message.layers, message.exact);
  }
  if (is_missing) mailbox_.ask_for_layers();
}

PageResponse ViewSession::get(const std::string& path, const std::string& query) const {
  std::shared_ptr<const ViewImage> image;
  {
    const std::lock_guard lock(mutex_);
    image = image_;
  }
  return save_picture(options_.scene, image.get(), path, query);
}

void ViewSession::change_status(const std::function<void(StatusText&)>& change) {
  const std::lock_guard lock(mutex_);
  change(status_);
  status_.viewers = viewers_.count();
  viewers_.set_status(status_message(status_));
}

// On the thread that renders. -----------------------------------------------------------------------------------------

ViewFailure ViewSession::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

void ViewSession::fail(const std::string& message, ViewFailure failure) {
  const bool is_fatal = failure != ViewFailure::none;
  is_idle_ = true;
  {
    const std::lock_guard lock(mutex_);
    failure_ = failure;
    if (is_fatal) fatal_error_ = message;
    viewers_.tell_everyone(error_message(message, is_fatal));
  }
  change_status([](StatusText& status) {
    status.activity = "failed";
    status.denoising = false;
  });
  if (is_fatal) options_.report(message);
}

void ViewSession::run() {
  try {
    load();
    render();
  } catch (const Cancelled&) {  // by stop()
  } catch (...) {
    ViewFailure failure = ViewFailure::none;
    const std::string message = text_of_error(&failure);
    fail(message, failure);
  }
}

ProgressFunction ViewSession::building() {
  return [this](const Progress& progress) {
    if (progress.samples_total > 0) return true;
    return !mailbox_.is_ending();
  };
}

void ViewSession::load() {
  change_status([](StatusText& status) { status.activity = "reading"; });
  Scene scene = Scene::load(options_.scene, options_.load, [this](const Progress&) { return !mailbox_.is_ending(); });
  tell_new(scene.warnings());
  {
    const std::lock_guard lock(scene_mutex_);
    renderer_ = std::make_unique<ViewRenderer>(std::move(scene), options_.settings, mailbox_, scene_mutex_);
  }
  extent_ = extent_of(renderer_->scene().bounds(), renderer_->scene().up());
  tell_scene();
  tell_camera(0);
  change_status([](StatusText& status) { status.activity = "building"; });
}

void ViewSession::tell_scene() {
  const Scene& scene = renderer_->scene();
  SceneText text;
  text.name = std::filesystem::path(options_.scene).filename().string();
  text.path = options_.scene;
  text.width = renderer_->width();
  text.height = renderer_->height();
  text.up = extent_.up;
  text.left_handed = is_left_handed(renderer_->camera());
  text.middle = extent_.middle;
  text.radius = extent_.radius;
  text.cameras = options_.cameras;
  for (const MaterialId material : scene.materials()) text.materials.push_back(scene.name(material));
  text.layers = {{"color", {"R", "G", "B"}}, {"denoised", {"R", "G", "B"}}};
  text.layers.insert(text.layers.end(), view_layers().begin(), view_layers().end());
  if (options_.animation)
    text.animation = {(*options_.animation)[0], (*options_.animation)[1], options_.load.frames_per_second};
  const Settings& settings = renderer_->settings();
  text.environment =
      EnvironmentMessage{settings.environment_rotation, settings.environment_strength, settings.light_scale};
  text.samples = renderer_->samples();
  text.exposure = options_.exposure;
  text.tone_map = options_.tone_map;
  text.options = options_.options;
  const std::lock_guard lock(mutex_);
  scene_text_ = text;
  viewers_.tell_everyone(scene_message(text));
}

void ViewSession::tell_camera(ViewerId by) {
  viewers_.set_camera(camera_message(page_camera(renderer_->camera(), extent_), {}), by);
}

void ViewSession::tell_warnings() { tell_new(renderer_->warnings()); }

void ViewSession::tell_new(const std::vector<Warning>& warnings) {
  for (const Warning& warning : warnings) {
    if (std::find(told_warnings_.begin(), told_warnings_.end(), warning) != told_warnings_.end()) continue;
    told_warnings_.push_back(warning);
    {
      const std::lock_guard lock(mutex_);
      logs_.push_back(warning.text());
      viewers_.tell_everyone(log_message(warning.text()));
    }
    options_.report("warning: " + warning.text());
  }
}

void ViewSession::render() {
  begin_view();
  bool was_shown = false;
  while (!mailbox_.is_ending()) {
    Mail mail = mailbox_.take();
    try {
      if (!mail.is_empty()) apply(mail);
      render_next();
      was_shown = was_shown || picture_number_ > 0;
    } catch (const Cancelled&) {
      throw;
    } catch (...) {
      const std::string error = text_of_error();
      if (const std::set<std::string> layers = rendered_layers(); !layers.empty()) {
        refused_layers_.insert(layers.begin(), layers.end());
        begin_image();
        viewers_.tell_everyone(error_message(error, false));
      } else if (was_shown) {
        // What a page has asked for, such as a size, may be too much; the next may not.
        fail(error, ViewFailure::none);
      } else {
        throw;
      }
    }
  }
}

void ViewSession::render_next() {
  if (is_idle_) {
    mailbox_.wait();
  } else if (step_ > 0) {
    render_coarse();
  } else if (!is_started_) {
    start_image();
  } else if (!renderer_->is_done() && !mailbox_.is_paused()) {
    render_pass();
  } else if (renderer_->is_done() && mailbox_.denoises() && !is_denoised_) {
    denoise();
  } else {
    const char* const activity = renderer_->is_done() ? "done" : "paused";
    change_status([&](StatusText& status) {
      is_at_rest_ = true;
      status.activity = activity;
      status.remaining = renderer_->is_done() ? std::optional<double>(0) : std::nullopt;
    });
    mailbox_.wait();
  }
}

void ViewSession::render_coarse() {
  // The first picture of a view is made in any case, or pages that ask faster than it takes would never see one.
  std::optional<ViewImage> image = renderer_->render_coarse(step_, !is_first_of_view_, building());
  if (!image) return;
  tell_warnings();
  if (is_first_of_view_) change_status([](StatusText& status) { status.activity = "rendering"; });
  show(std::move(*image));
  is_first_of_view_ = false;
  step_ /= 2;
  if (!mailbox_.is_moving()) return;
  if (!mailbox_.wait(rest_time)) mailbox_.settle();
}

void ViewSession::start_image() {
  renderer_->start([this](const Progress& progress) {
    if (progress.samples_total == 0) return !mailbox_.is_ending();
    change_status([&](StatusText& status) {
      if (is_at_rest_) return;
      status.activity = mailbox_.is_paused() ? "paused" : "rendering";
      const double pixels = std::max(1.0, static_cast<double>(progress.pixels));
      status.samples = static_cast<double>(progress.samples_done) / pixels;
      status.samples_total = static_cast<int64_t>(static_cast<double>(progress.samples_total) / pixels + 0.5);
      status.seconds = progress.seconds;
      status.remaining.reset();
      if (progress.fraction > 0) status.remaining = progress.seconds / progress.fraction * (1 - progress.fraction);
    });
    return true;
  });
  is_started_ = true;
  change_status([this](StatusText& status) { status.samples_total = renderer_->samples(); });
  curve_.clear();
  tell_warnings();
}

void ViewSession::render_pass() {
  const double seconds = renderer_->progress().seconds;
  {
    const std::lock_guard lock(mutex_);
    is_at_rest_ = false;
  }
  if (!renderer_->render_pass(seconds < 1 ? 0.1 : 0.75)) return;
  ViewImage image = renderer_->image();
  curve_.add(image.picture);
  {
    const std::lock_guard lock(mutex_);
    status_.error = curve_.error();
    status_.curve = curve_.points();
    status_.samples = image.picture->samples;
    status_.seconds = image.description.seconds;
  }
  show(std::move(image));
}

void ViewSession::denoise() {
  change_status([](StatusText& status) { status.denoising = true; });
  is_denoised_ = true;
  ViewImage image = renderer_->denoised();
  tell_warnings();
  image.picture->number = ++picture_number_;
  image.picture->view = view_;
  viewers_.show(image.picture, origin_);
  change_status([](StatusText& status) { status.denoising = false; });
}

void ViewSession::show(ViewImage&& image) {
  image.picture->number = ++picture_number_;
  image.picture->view = view_;
  if (placed_) image.description.metadata["settings"] += ' ' + camera_options(*placed_);
  const std::shared_ptr<const Picture> picture = image.picture;
  if (picture->step == 1) {
    const std::lock_guard lock(mutex_);
    image_ = std::make_shared<const ViewImage>(std::move(image));
  }
  viewers_.show(picture, origin_);
}

/// What is seen has changed.
void ViewSession::begin_view() {
  ++view_;
  is_first_of_view_ = true;
  {
    const std::lock_guard lock(mutex_);
    status_.error.reset();
    status_.curve.clear();
    image_.reset();
  }
  begin_image();
}

/// The same is to be rendered in another way.
void ViewSession::begin_image() {
  is_idle_ = is_started_ = is_denoised_ = false;
  renderer_->set_denoising(mailbox_.denoises());
  std::set<std::string> layers;
  {
    // As one, so that a layer which is asked for meanwhile is either among these or seen to be missing.
    const std::lock_guard lock(mutex_);
    layers = viewers_.wanted_layers();
    layers.erase("color");
    layers.erase("denoised");
    for (const std::string& layer : refused_layers_) layers.erase(layer);
    layers_ = layers;
    layers_.insert(refused_layers_.begin(), refused_layers_.end());
  }
  renderer_->set_layers(layers);
  if (picture_number_ > 0)
    change_status([this](StatusText& status) {
      is_at_rest_ = true;  // until the next image takes its first pass
      status.activity = "rendering";
    });
  step_ = renderer_->suitable_step();
}

std::set<std::string> ViewSession::rendered_layers() const {
  std::set<std::string> layers;
  for (const auto& [layer, channels] : view_layers())
    if (renderer_->renders(layer)) layers.insert(layer);
  return layers;
}

}  // namespace alhazen::impl
