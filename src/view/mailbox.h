#pragma once

// What pages ask for, on its way to the thread that renders. Only the latest of each kind is kept, so that nothing
// queues up however fast pages send.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <variant>

#include "alhazen/renderer.h"
#include "view/page_server.h"
#include "view/protocol.h"

namespace alhazen::impl {

template <class Message>
struct From {
  ViewerId viewer = 0;
  Message message;
};

using CameraRequest = std::variant<CameraMessage, ResetMessage, SelectCameraMessage>;

/// What has changed since the last was taken.
struct Mail {
  std::optional<From<CameraRequest>> camera;
  std::optional<From<SizeMessage>> size;
  std::optional<From<SamplesMessage>> samples;
  std::optional<From<EnvironmentMessage>> environment;
  std::map<size_t, From<MaterialMessage>> materials;  ///< by material, values of several messages together
  bool layers = false;                                ///< a layer is wanted that is not rendered
  bool denoise = false;                               ///< a denoised picture is wanted, and was not before
  bool state = false;                                 ///< paused, or less is wanted

  /// Whether an image that is under way is of no use any more.
  bool outdates_image() const {
    return camera || size || samples || environment || !materials.empty() || layers || denoise;
  }
  bool is_empty() const { return !outdates_image() && !state; }
};

class Mailbox {
 public:
  // By any thread. ----------------------------------------------------------------------------------------------------

  void post(ViewerId viewer, CameraRequest request);
  void post(ViewerId viewer, const SizeMessage& message);
  void post(ViewerId viewer, const SamplesMessage& message);
  void post(ViewerId viewer, const EnvironmentMessage& message);
  void post(ViewerId viewer, const MaterialMessage& message);
  void ask_for_layers();
  void pause(bool paused);
  void denoise(bool on);
  /// The viewer is gone, and moves no camera any more.
  void leave(ViewerId viewer);
  /// Ends a pass under way, and all that waits.
  void end();

  bool is_paused() const;
  bool denoises() const;
  bool is_ending() const;

  // By the thread that renders. ---------------------------------------------------------------------------------------

  Mail take();
  /// Waits for mail, the end, or so long. Returns whether there is mail or the end.
  bool wait(std::optional<std::chrono::milliseconds> limit = {});
  /// Whether the last camera is one of several that follow each other; not after `settle`.
  bool is_moving() const;
  void settle();
  /// Takes a pass, which mail that outdates the image ends, if it may be interrupted; else the end alone. Nothing is
  /// taken if such mail is there. Returns what render_pass returns, or nothing if the pass was interrupted.
  std::optional<bool> render_pass(Renderer& renderer, int64_t samples, bool is_interruptible);

 private:
  template <class Change>
  void change(const Change& change_mail);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Mail mail_;
  bool is_paused_ = false, denoises_ = false, is_moving_ = false, is_ending_ = false;
  ViewerId moving_by_ = 0;
  Renderer* in_pass_ = nullptr;  ///< what a pass is taken of. `stop` is called in no other state: it would end `start`
  bool is_interruptible_ = false, is_interrupted_ = false;
};

}  // namespace alhazen::impl
