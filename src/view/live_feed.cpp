#include "view/live_feed.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "util/diagnostics.h"
#include "util/processor_time.h"
#include "view/overloaded.h"
#include "view/page_sender.h"
#include "view/save_picture.h"

namespace alhazen::impl {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds poll_interval{20};

}  // namespace

/// Passes messages on, and knows which frames have been drawn and what sending them costs.
class LiveFeed::Sender final : public PageSender {
 public:
  /// All frames are sent by one thread, which also compresses them, so its time is the cost of them all.
  void send_binary(ViewerId viewer, std::shared_ptr<const std::string> bytes) override {
    PageSender::send_binary(viewer, std::move(bytes));
    const std::lock_guard lock(mutex_);
    seconds_ = thread_processor_seconds();
  }

  double take_seconds() {
    const std::lock_guard lock(mutex_);
    return seconds_ - std::exchange(told_, seconds_);
  }

 private:
  std::mutex mutex_;
  double seconds_ = 0, told_ = 0;
};

LiveFeed::LiveFeed(const PageServerOptions& options, LiveFeedEvents events)
    : events_(std::move(events)), sender_(std::make_unique<Sender>()), viewers_(std::make_unique<Viewers>(*sender_)) {
  PageEvents pages;
  pages.opened = [this](ViewerId viewer) {
    viewers_->open(viewer);
    send_status();
  };
  pages.message = [this](ViewerId viewer, std::string_view text) { handle_message(viewer, text); };
  pages.closed = [this](ViewerId viewer) {
    viewers_->close(viewer);
    send_status();
  };
  pages.get = [this](const std::string& path, const std::string& query) { return get(path, query); };
  server_ = std::make_unique<PageServer>(options, std::move(pages));
  sender_->set_server(server_.get());
}

/// Nothing is sent by a server that ends; it may still call, and finds the viewers.
LiveFeed::~LiveFeed() {
  sender_->set_server(nullptr);
  server_.reset();
}

void LiveFeed::begin(const SceneText& scene) {
  {
    const std::lock_guard lock(mutex_);
    scene_ = scene;
    scene_->read_only = true;
    ++view_;
    curve_.clear();
    image_ = {};
    status_.activity = "rendering";
    status_.samples_total = scene.samples;
    status_.error.reset();
    status_.curve.clear();
    viewers_->tell_everyone(scene_message(*scene_));
  }
  send_status();
}

std::set<std::string> LiveFeed::wanted_layers() const { return viewers_->wanted_layers(); }

bool LiveFeed::is_waited_for() const {
  const std::set<std::string> wanted = wanted_layers();
  const std::lock_guard lock(mutex_);
  return std::any_of(wanted.begin(), wanted.end(), [&](const std::string& layer) {
    const bool exists = scene_ && std::any_of(scene_->layers.begin(), scene_->layers.end(),
                                              [&](const auto& known) { return known.first == layer; });
    return exists && !(image_.picture && image_.picture->layer(layer));
  });
}

void LiveFeed::show(const ViewImage& image) {
  {
    const std::lock_guard lock(mutex_);
    image.picture->number = ++number_;
    image.picture->view = view_;
    image_ = image;
    status_.activity = image.picture->is_final ? "done" : "rendering";
    if (image.picture->is_final) status_.remaining.reset();
    status_.samples = image.picture->samples;
    curve_.add(image.picture);
    status_.error = curve_.error();
    status_.curve = curve_.points();
  }
  viewers_->show(image.picture);
  send_status();
}

void LiveFeed::report(const Progress& p) {
  {
    const std::lock_guard lock(mutex_);
    if (status_.activity != std::string_view("done")) status_.activity = "rendering";
    if (p.pixels > 0) status_.samples = static_cast<double>(p.samples_done) / static_cast<double>(p.pixels);
    status_.seconds = p.seconds;
    status_.remaining.reset();
    const uint64_t taken = p.samples_done - std::min(p.samples_loaded, p.samples_done);
    if (taken > 0 && p.samples_total >= p.samples_done)
      status_.remaining =
          p.seconds / static_cast<double>(taken) * static_cast<double>(p.samples_total - p.samples_done);
    // That of a noise target is better than the estimate by two pictures.
    if (p.noise > 0) status_.error = p.noise;
  }
  send_status();
}

void LiveFeed::say(const std::string& warning) { viewers_->tell_everyone(log_message(warning)); }

void LiveFeed::send_status() {
  const std::lock_guard lock(mutex_);
  status_.viewers = viewers_->count();
  if (status_.viewers > 0) viewers_->set_status(status_message(status_));
}

void LiveFeed::flush(double patience) {
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(patience));
  while (viewers_->count() > 0 && !viewers_->is_idle() && Clock::now() < end)
    std::this_thread::sleep_for(poll_interval);
}

double LiveFeed::take_seconds() { return sender_->take_seconds(); }

void LiveFeed::handle_message(ViewerId viewer, std::string_view text) {
  try {
    handle(viewer, parse_page_message(text));
  } catch (const std::exception& error) {
    viewers_->tell(viewer, error_message(error.what(), false));
  }
}

void LiveFeed::handle(ViewerId viewer, const PageMessage& message) {
  std::visit(Overloaded{
                 [&](const HelloMessage&) { greet(viewer); },
                 [&](const LayersMessage& m) { viewers_->want(viewer, m.layers, m.exact); },
                 [&](const AckMessage& m) { viewers_->acknowledge(viewer, m.frame); },
                 [&](const StopMessage&) { events_.stop(); },
                 [&](const SaveMessage&) { events_.save(); },
                 [&](const auto&) {
                   throw InputError(
                       "this is the view of a render, which shows it and does not change it: "
                       "'alhazen view' has a view that can be changed");
                 },
             },
             message);
}

void LiveFeed::greet(ViewerId viewer) {
  {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> greetings;
    if (scene_) greetings.push_back(scene_message(*scene_));
    viewers_->welcome(viewer, greetings);
  }
  send_status();
}

PageResponse LiveFeed::get(const std::string& path, const std::string& query) const {
  ViewImage image;
  std::string name;
  {
    const std::lock_guard lock(mutex_);
    image = image_;
    if (scene_) name = scene_->name;
  }
  return save_picture(name, image.picture ? &image : nullptr, path, query);
}

}  // namespace alhazen::impl
