// A client of the server of views: bytes of a request and, after the empty line that ends it, of a WebSocket. They go
// through a pair of sockets to the code that serves connections, which runs on this thread.

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "view/server/asio.h"
#include "view/server/http_connection.h"
#include "view/server/hub.h"

namespace alhazen::impl {

// In the place of the page itself.
std::string_view page_html() { return "<!doctype html><script nonce=\"NONCE_OF_THIS_ANSWER\"></script>"; }

namespace {

constexpr size_t max_input_bytes = 16384;

struct Conversation {
  explicit Conversation(int descriptor)
      : hub(context, {.max_viewers = 1, .max_queued_bytes = 4096, .token = "t"}, events(),
            AllowedHosts("localhost", *parse_ip_address("127.0.0.1")),
            [](const std::function<void()>& job) { job(); }) {
    tcp::socket socket(context);
    socket.assign(tcp::v4(), descriptor);
    serve(hub, std::move(socket));
  }

  PageEvents events() {
    PageEvents result;
    result.opened = [this](ViewerId) { ++open; };
    result.message = [this](ViewerId id, std::string_view text) {
      if (open != 1 || text.size() > max_input_bytes) std::abort();
      // Beast has checked that it is UTF-8; it goes back as it came.
      if (const auto viewer = hub.viewer(id)) viewer->send({std::make_shared<const std::string>(text), false});
    };
    result.closed = [this](ViewerId) {
      if (--open != 0) std::abort();
    };
    result.get = [](const std::string& path, const std::string& query) {
      return PageResponse{.file_name = path, .body = query};
    };
    return result;
  }

  void run() {
    context.restart();
    while (context.poll() > 0) {
    }
  }

  int open = 0;
  net::io_context context{1};
  Hub hub;
};

/// What the server has sent since.
std::string receive(int descriptor) {
  std::string all;
  char bytes[4096];
  for (ssize_t count = 0; (count = ::recv(descriptor, bytes, sizeof(bytes), MSG_DONTWAIT)) > 0;)
    all.append(bytes, static_cast<size_t>(count));
  return all;
}

}  // namespace
}  // namespace alhazen::impl

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace alhazen::impl;
  if (size > max_input_bytes) return 0;
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends) != 0) std::abort();
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const size_t blank = bytes.find("\r\n\r\n");
  const std::string_view request = bytes.substr(0, blank == std::string_view::npos ? blank : blank + 4);
  {
    Conversation conversation(ends[0]);
    for (const std::string_view part : {request, bytes.substr(request.size())}) {
      if (!part.empty() && ::send(ends[1], part.data(), part.size(), MSG_NOSIGNAL) < 0 && errno != EPIPE) std::abort();
      conversation.run();
      const std::string answer = receive(ends[1]);
      // Nobody without the token learns anything of the page.
      if (answer.find("<!doctype html>") != std::string::npos && bytes.find("/t/") == std::string_view::npos)
        std::abort();
      conversation.run();
    }
    ::shutdown(ends[1], SHUT_WR);
    conversation.run();
    // All connections end where the other side has ended.
    for (int i = 0; i < 100 && conversation.hub.connections() > 0; ++i) {
      receive(ends[1]);
      conversation.run();
    }
    if (conversation.hub.connections() > 0) std::abort();
    if (conversation.hub.viewers() > 0 || conversation.open != 0) std::abort();
  }
  ::close(ends[1]);
  return 0;
}
