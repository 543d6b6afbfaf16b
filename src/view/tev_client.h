#pragma once

// Shows images in tev, over its protocol (view/tev_packets.h). A tev that is missing, closes or stops reading never
// keeps the caller: a thread connects and sends, and of several images with one name only the last waits for it.

#include <memory>
#include <string>

#include "images/image.h"

namespace alhazen::impl {

struct TevAddress {
  std::string host = "127.0.0.1";  ///< a name or an address, without brackets
  int port = 14158;

  std::string to_string() const;
};

/// HOST, HOST:PORT, [IPV6]:PORT, IPV6 or :PORT. Throws InputError.
TevAddress parse_tev_address(const std::string& text);

class TevClient {
 public:
  /// Throws RenderError if the system gives no thread.
  explicit TevClient(const TevAddress& address);
  /// Takes at most a second, whatever the thread is doing; what is not sent then is lost.
  ~TevClient();
  TevClient(const TevClient&) = delete;
  TevClient& operator=(const TevClient&) = delete;

  /// Hands an image over to be shown under its name, in place of one that still waits under it.
  void show(const std::string& name, Image&& image);
  /// Waits until all is sent, as long as tev goes on reading: it returns after `patience` seconds without progress, and
  /// at once if there is no tev.
  void flush(double patience = 2);
  /// What went wrong first, as a sentence, once; empty if nothing did or it was told. After a failure, each image that
  /// follows may find another tev at the address.
  std::string take_problem();
  /// Processor time that the thread has spent since the last call.
  double take_seconds();

 private:
  class Sender;
  std::shared_ptr<Sender> sender_;  ///< shared with the thread
};

}  // namespace alhazen::impl
