#include "view/viewers.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <tuple>
#include <utility>

#include "util/thread_limit.h"

namespace alhazen::impl {

namespace {

constexpr std::chrono::milliseconds text_interval{100};
/// What everyone is told is left out for a viewer that has so many bytes still to read.
constexpr size_t max_queued_for_texts = size_t{1} << 20;

/// Whether `next` is to be shown after `current`.
bool is_better(const Picture& next, const Picture& current) {
  if (next.view != current.view) return next.view > current.view;
  if (next.step != current.step) return next.step < current.step;
  return next.samples >= current.samples || next.is_final;
}

}  // namespace

Viewers::Viewers(ViewerSender& sender)
    : sender_(sender), thread_(start_thread("the thread that sends pictures to pages", [this] { run(); })) {}

Viewers::~Viewers() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Viewers::open(ViewerId viewer) {
  const std::lock_guard lock(mutex_);
  viewers_[viewer];
}

void Viewers::close(ViewerId viewer) {
  const std::lock_guard lock(mutex_);
  viewers_.erase(viewer);
  if (camera_by_ == viewer) camera_by_ = 0;
}

void Viewers::welcome(ViewerId viewer, const std::vector<std::string>& greetings) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = viewers_.find(viewer);
    if (found == viewers_.end()) return;
    for (const std::string& text : greetings) sender_.send_text(viewer, std::make_shared<const std::string>(text));
    found->second.is_welcome = true;
    found->second.has_status = found->second.has_camera = false;
    // A page that says hello again has lost what it had.
    found->second.in_flight.reset();
    found->second.sent.clear();
  }
  changed_.notify_all();
}

void Viewers::want(ViewerId viewer, const std::vector<std::string>& layers, bool exact) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = viewers_.find(viewer);
    if (found == viewers_.end()) return;
    Viewer& v = found->second;
    v.layers.clear();
    for (const std::string& layer : layers)
      if (std::find(v.layers.begin(), v.layers.end(), layer) == v.layers.end()) v.layers.push_back(layer);
    v.exact = exact;
    std::erase_if(v.sent, [&](const auto& entry) {
      return std::find(v.layers.begin(), v.layers.end(), entry.first) == v.layers.end();
    });
  }
  changed_.notify_all();
}

void Viewers::acknowledge(ViewerId viewer, uint64_t frame) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = viewers_.find(viewer);
    if (found == viewers_.end() || found->second.in_flight != frame) return;
    found->second.in_flight.reset();
  }
  changed_.notify_all();
}

size_t Viewers::count() const {
  const std::lock_guard lock(mutex_);
  return viewers_.size();
}

std::set<std::string> Viewers::wanted_layers() const {
  const std::lock_guard lock(mutex_);
  std::set<std::string> layers;
  for (const auto& [id, viewer] : viewers_) layers.insert(viewer.layers.begin(), viewer.layers.end());
  return layers;
}

bool Viewers::is_idle() const {
  const std::lock_guard lock(mutex_);
  return std::none_of(viewers_.begin(), viewers_.end(),
                      [](const auto& entry) { return entry.second.is_welcome && entry.second.in_flight; }) &&
         next_deliveries().empty() && !has_texts();
}

void Viewers::tell(ViewerId viewer, const std::string& text) {
  const std::lock_guard lock(mutex_);
  if (viewers_.contains(viewer)) send(viewer, std::make_shared<const std::string>(text));
}

void Viewers::tell_everyone(const std::string& text) {
  const auto shared = std::make_shared<const std::string>(text);
  const std::lock_guard lock(mutex_);
  for (const auto& [id, viewer] : viewers_)
    if (viewer.is_welcome) send(id, shared);
}

bool Viewers::send(ViewerId viewer, const std::shared_ptr<const std::string>& text) {
  if (sender_.queued_bytes(viewer) >= max_queued_for_texts) return false;
  sender_.send_text(viewer, text);
  return true;
}

void Viewers::set_status(const std::string& text) {
  {
    const std::lock_guard lock(mutex_);
    if (status_ && *status_ == text) return;
    status_ = std::make_shared<const std::string>(text);
    for (auto& [id, viewer] : viewers_) viewer.has_status = false;
  }
  changed_.notify_all();
}

void Viewers::set_camera(const std::string& text, ViewerId by) {
  {
    const std::lock_guard lock(mutex_);
    camera_ = std::make_shared<const std::string>(text);
    camera_by_ = by;
    for (auto& [id, viewer] : viewers_) viewer.has_camera = by != 0 && id == by;
  }
  changed_.notify_all();
}

void Viewers::show(const std::shared_ptr<const Picture>& picture, const std::optional<ViewOrigin>& origin) {
  {
    const std::lock_guard lock(mutex_);
    for (const PictureLayer& layer : picture->layers) {
      Shown& shown = shown_[layer.name];
      if (!shown.picture || is_better(*picture, *shown.picture)) shown = {picture, origin};
    }
  }
  changed_.notify_all();
}

std::shared_ptr<const Picture> Viewers::shown(const std::string& layer) const {
  const std::lock_guard lock(mutex_);
  const auto found = shown_.find(layer);
  return found == shown_.end() ? nullptr : found->second.picture;
}

std::vector<Viewers::Delivery> Viewers::next_deliveries() const {
  std::vector<Delivery> deliveries;
  for (const auto& [id, viewer] : viewers_) {
    if (!viewer.is_welcome || viewer.in_flight) continue;
    const FrameType type = viewer.exact ? FrameType::single : FrameType::half;
    for (const std::string& layer : viewer.layers) {
      const auto shown = shown_.find(layer);
      if (shown == shown_.end()) continue;
      const auto sent = viewer.sent.find(layer);
      const std::shared_ptr<EncodedLayer> previous = sent == viewer.sent.end() ? nullptr : sent->second;
      if (previous && previous->type() == type && &previous->picture() == shown->second.picture.get()) continue;
      deliveries.push_back({id, layer, shown->second, type, previous, {}});
    }
  }
  return deliveries;
}

bool Viewers::has_texts() const {
  return std::any_of(viewers_.begin(), viewers_.end(), [&](const auto& entry) {
    const Viewer& viewer = entry.second;
    return viewer.is_welcome && ((status_ && !viewer.has_status) || (camera_ && !viewer.has_camera));
  });
}

void Viewers::send_texts() {
  for (auto& [id, viewer] : viewers_) {
    if (!viewer.is_welcome) continue;
    if (camera_ && !viewer.has_camera) viewer.has_camera = send(id, camera_);
    if (status_ && !viewer.has_status) viewer.has_status = send(id, status_);
  }
}

std::shared_ptr<EncodedLayer> Viewers::encoded(const Delivery& delivery) {
  std::erase_if(encodings_, [](const std::weak_ptr<EncodedLayer>& entry) { return entry.expired(); });
  const PictureLayer* const layer = delivery.shown.picture->layer(delivery.layer);
  for (const std::weak_ptr<EncodedLayer>& entry : encodings_)
    if (const std::shared_ptr<EncodedLayer> known = entry.lock();
        known && &known->layer() == layer && known->type() == delivery.type)
      return known;
  auto made = std::make_shared<EncodedLayer>(delivery.shown.picture, *layer, delivery.type);
  encodings_.push_back(made);
  return made;
}

void Viewers::deliver(std::vector<Delivery>& deliveries) {
  const uint64_t frame = ++frame_;
  // Viewers that have the same and get the same share the message.
  std::map<std::tuple<const EncodedLayer*, const EncodedLayer*, uint64_t>, std::shared_ptr<const std::string>> messages;
  std::vector<std::shared_ptr<const std::string>> texts;
  for (Delivery& delivery : deliveries) {
    delivery.encoded = encoded(delivery);
    FrameLabel label{frame, {}};
    const std::optional<ViewOrigin>& origin = delivery.shown.origin;
    if (origin && origin->viewer == delivery.viewer) label.camera_id = origin->camera_id;
    auto& message =
        messages[{delivery.encoded.get(), delivery.previous.get(), label.camera_id ? *label.camera_id : ~uint64_t{0}}];
    if (!message)
      message = std::make_shared<const std::string>(delivery.encoded->frame(label, delivery.previous.get()));
    texts.push_back(message);
  }
  const std::lock_guard lock(mutex_);
  for (size_t i = 0; i < deliveries.size(); ++i) {
    const Delivery& delivery = deliveries[i];
    const auto found = viewers_.find(delivery.viewer);
    if (found == viewers_.end()) continue;
    Viewer& viewer = found->second;
    // It may have said hello again, or have changed what it wants, meanwhile.
    const auto sent = viewer.sent.find(delivery.layer);
    if ((sent == viewer.sent.end() ? nullptr : sent->second) != delivery.previous) continue;
    if (std::find(viewer.layers.begin(), viewer.layers.end(), delivery.layer) == viewer.layers.end()) continue;
    std::shared_ptr<EncodedLayer>& last = viewer.sent[delivery.layer];
    sender_.send_binary(delivery.viewer, texts[i]);
    last = delivery.encoded;
    viewer.in_flight = frame;
  }
}

void Viewers::run() {
  auto next_texts = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  while (!is_ending_) {
    try {
      const auto now = std::chrono::steady_clock::now();
      if (has_texts() && now >= next_texts) {
        send_texts();
        next_texts = now + text_interval;
      }
      if (std::vector<Delivery> deliveries = next_deliveries(); !deliveries.empty()) {
        lock.unlock();
        deliver(deliveries);
        deliveries.clear();
        lock.lock();
        continue;
      }
      if (has_texts())
        changed_.wait_until(lock, next_texts);
      else
        changed_.wait(lock);
    } catch (const std::bad_alloc&) {
      // Without memory for it, this picture is not seen; the next one may be.
      if (!lock.owns_lock()) lock.lock();
      changed_.wait_for(lock, text_interval);
    }
  }
}

}  // namespace alhazen::impl
