#pragma once

// The pages that are connected: what each wants to see and has been sent. A thread sends them what is newest, each as
// fast as it acknowledges, so that a slow one delays neither the render nor the others.

#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "view/frame_encoder.h"
#include "view/page_server.h"
#include "view/picture.h"

namespace alhazen::impl {

/// What messages are sent by: a PageServer, or in tests something else. Any thread may call it.
class ViewerSender {
 public:
  virtual ~ViewerSender() = default;
  virtual void send_text(ViewerId viewer, std::shared_ptr<const std::string> text) = 0;
  virtual void send_binary(ViewerId viewer, std::shared_ptr<const std::string> bytes) = 0;
  virtual size_t queued_bytes(ViewerId viewer) const = 0;
};

/// Who asked for the camera of a view.
struct ViewOrigin {
  ViewerId viewer = 0;
  uint64_t camera_id = 0;
};

class Viewers {
 public:
  explicit Viewers(ViewerSender& sender);
  ~Viewers();
  Viewers(const Viewers&) = delete;
  Viewers& operator=(const Viewers&) = delete;

  // All may be called by any thread. Calls for viewers that are gone do nothing.

  void open(ViewerId viewer);
  void close(ViewerId viewer);
  /// From now on it is sent pictures and what everyone is told; first `greetings`.
  void welcome(ViewerId viewer, const std::vector<std::string>& greetings);
  void want(ViewerId viewer, const std::vector<std::string>& layers, bool exact);
  void acknowledge(ViewerId viewer, uint64_t frame);

  size_t count() const;
  std::set<std::string> wanted_layers() const;
  /// Whether every viewer has acknowledged all that is shown and that it wants, and has been told all.
  bool is_idle() const;

  void tell(ViewerId viewer, const std::string& text);
  void tell_everyone(const std::string& text);
  /// These are told at most ten times a second, always the last: the state of the render, and the camera, which its
  /// viewer is not told of (0: all are).
  void set_status(const std::string& text);
  void set_camera(const std::string& text, ViewerId by);

  /// Each layer of it is what viewers see from now on, if it is better than what they see: of a later view; or of the
  /// same with smaller pixels, or more samples, or as the last.
  void show(const std::shared_ptr<const Picture>& picture, const std::optional<ViewOrigin>& origin = {});

  /// What is shown of a layer; null: nothing yet.
  std::shared_ptr<const Picture> shown(const std::string& layer) const;

 private:
  struct Shown {
    std::shared_ptr<const Picture> picture;
    std::optional<ViewOrigin> origin;
  };
  struct Viewer {
    bool is_welcome = false;
    bool exact = false;
    std::vector<std::string> layers{"color"};
    std::optional<uint64_t> in_flight;                          ///< frame that it has not acknowledged yet
    std::map<std::string, std::shared_ptr<EncodedLayer>> sent;  ///< its last frame of each layer
    bool has_status = false, has_camera = false;                ///< the last
  };
  struct Delivery {
    ViewerId viewer;
    std::string layer;
    Shown shown;
    FrameType type;
    std::shared_ptr<EncodedLayer> previous, encoded;
  };

  void run();
  std::vector<Delivery> next_deliveries() const;
  void deliver(std::vector<Delivery>& deliveries);
  std::shared_ptr<EncodedLayer> encoded(const Delivery& delivery);
  bool has_texts() const;
  void send_texts();
  /// False, and nothing is sent, if the viewer has too much still to read.
  bool send(ViewerId viewer, const std::shared_ptr<const std::string>& text);

  ViewerSender& sender_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<ViewerId, Viewer> viewers_;
  std::map<std::string, Shown> shown_;
  std::shared_ptr<const std::string> status_, camera_;
  ViewerId camera_by_ = 0;
  uint64_t frame_ = 0;
  bool is_ending_ = false;
  std::vector<std::weak_ptr<EncodedLayer>> encodings_;  ///< of the thread alone
  std::thread thread_;                                  ///< the last member: it uses the others
};

}  // namespace alhazen::impl
