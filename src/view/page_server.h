#pragma once

// Serves the page of `alhazen view`, and carries messages between its viewers and the program, over HTTP and WebSocket
// (RFC 6455). One thread of its own does all of it.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace alhazen::impl {

/// A page that is connected; never 0, and never used twice.
using ViewerId = uint64_t;

struct PageServerOptions {
  std::string address = "127.0.0.1";  ///< to listen on: an address of this machine
  /// 0 to 65535; 0: any free one. If it is taken, the next free one is used, unless `only_this_port`.
  int port = 0;
  bool only_this_port = false;
  size_t max_viewers = 16;
  /// Bytes that may wait to be sent to one viewer, beside the message that is being sent. One that reads too slowly for
  /// them is disconnected. A single message may be larger.
  size_t max_queued_bytes = size_t{64} << 20;
  std::string token = {};  ///< that URLs must have; empty: a random one of 128 bits
};

/// What a GET request is answered with.
struct PageResponse {
  int status = 200;
  std::string content_type = "text/plain; charset=utf-8";
  std::string file_name = {};  ///< not empty: offered as a download of this name
  std::string body = {};
};

/// What the server asks of the program, each on the server's thread, so quickly. None of them may throw. Once the
/// server's destructor has begun, none is called any more; one that has been called is waited for.
struct PageEvents {
  std::function<void(ViewerId)> opened;
  std::function<void(ViewerId, std::string_view)> message;  ///< text in UTF-8, at most 1 MiB
  std::function<void(ViewerId)> closed;
  /// Of what lies below the page: "save.exr" with the query "exposure=1" (without the token). Called on a thread that
  /// may take its time, one request after another.
  std::function<PageResponse(const std::string& path, const std::string& query)> get;
};

class PageServer {
 public:
  /// Listens, and begins to answer. Throws InputError for an address or a port that cannot be had, which says why.
  PageServer(const PageServerOptions& options, PageEvents events);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  int port() const;
  std::string url() const;  ///< of the page, with the token
  bool is_local() const;    ///< whether only this machine reaches it

  // Any thread may call these; they do nothing for a viewer that is gone.

  void send_text(ViewerId viewer, std::shared_ptr<const std::string> text);
  void send_binary(ViewerId viewer, std::shared_ptr<const std::string> bytes);
  size_t queued_bytes(ViewerId viewer) const;
  size_t viewers() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The page: one file of HTML with its script and style, embedded when the program is built.
std::string_view page_html();

}  // namespace alhazen::impl
