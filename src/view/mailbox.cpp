#include "view/mailbox.h"

#include <utility>

namespace alhazen::impl {

template <class Change>
void Mailbox::change(const Change& change_mail) {
  {
    const std::lock_guard lock(mutex_);
    change_mail();
    if (in_pass_ && (is_ending_ || (is_interruptible_ && mail_.outdates_image()))) {
      is_interrupted_ = true;
      in_pass_->stop();
    }
  }
  changed_.notify_all();
}

void Mailbox::post(ViewerId viewer, CameraRequest request) {
  change([&] {
    const auto* const camera = std::get_if<CameraMessage>(&request);
    is_moving_ = camera && camera->moving;
    moving_by_ = viewer;
    mail_.camera = {viewer, std::move(request)};
  });
}

void Mailbox::post(ViewerId viewer, const SizeMessage& message) {
  change([&] { mail_.size = {viewer, message}; });
}
void Mailbox::post(ViewerId viewer, const SamplesMessage& message) {
  change([&] { mail_.samples = {viewer, message}; });
}
void Mailbox::post(ViewerId viewer, const EnvironmentMessage& message) {
  change([&] { mail_.environment = {viewer, message}; });
}

void Mailbox::post(ViewerId viewer, const MaterialMessage& message) {
  constexpr size_t max_materials = 1024;
  change([&] {
    if (mail_.materials.size() >= max_materials && !mail_.materials.contains(message.material)) return;
    From<MaterialMessage>& kept = mail_.materials[message.material];
    kept.viewer = viewer;
    kept.message.material = message.material;
    for (const auto& [name, value] : message.values)
      if (kept.message.values.size() < max_materials) kept.message.values[name] = value;
  });
}

void Mailbox::ask_for_layers() {
  change([&] { mail_.layers = true; });
}
void Mailbox::pause(bool paused) {
  change([&] { mail_.state = true, is_paused_ = paused; });
}
void Mailbox::denoise(bool on) {
  change([&] {
    mail_.state = true;
    // It may have ended a pass already, so it is not taken back.
    mail_.denoise = mail_.denoise || (on && !denoises_);
    denoises_ = on;
  });
}
void Mailbox::leave(ViewerId viewer) {
  change([&] {
    if (moving_by_ == viewer) is_moving_ = false;
    mail_.state = true;
  });
}
void Mailbox::end() {
  change([&] { is_ending_ = true; });
}

bool Mailbox::is_paused() const {
  const std::lock_guard lock(mutex_);
  return is_paused_;
}
bool Mailbox::denoises() const {
  const std::lock_guard lock(mutex_);
  return denoises_;
}
bool Mailbox::is_ending() const {
  const std::lock_guard lock(mutex_);
  return is_ending_;
}
bool Mailbox::is_moving() const {
  const std::lock_guard lock(mutex_);
  return is_moving_;
}
void Mailbox::settle() {
  const std::lock_guard lock(mutex_);
  is_moving_ = false;
}

Mail Mailbox::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(mail_, {});
}

bool Mailbox::wait(std::optional<std::chrono::milliseconds> limit) {
  std::unique_lock lock(mutex_);
  const auto has_news = [&] { return is_ending_ || !mail_.is_empty(); };
  if (limit) return changed_.wait_for(lock, *limit, has_news);
  changed_.wait(lock, has_news);
  return true;
}

std::optional<bool> Mailbox::render_pass(Renderer& renderer, int64_t samples, bool is_interruptible) {
  {
    const std::lock_guard lock(mutex_);
    if (is_ending_ || (is_interruptible && mail_.outdates_image())) return {};
    in_pass_ = &renderer;
    is_interruptible_ = is_interruptible;
    is_interrupted_ = false;
  }
  const auto leave_pass = [&] {
    const std::lock_guard lock(mutex_);
    in_pass_ = nullptr;
    return is_interrupted_;
  };
  bool goes_on = false;
  try {
    goes_on = renderer.render_pass(samples);
  } catch (...) {
    leave_pass();
    throw;
  }
  if (leave_pass()) return {};
  return goes_on;
}

}  // namespace alhazen::impl
