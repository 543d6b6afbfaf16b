// Clients that keep to no rule: the connection ends, and all others are served.

#ifdef ALHAZEN_WITH_VIEW_SERVER

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>
#include <random>
#include <thread>
#include <vector>

#include "view/echo_server.h"
#include "view/page_client.h"

namespace alhazen::impl {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

/// Whether a viewer that was there before still has its messages sent back.
bool is_served(PageClient& client) {
  return client.send_text("still here") && client.receive_message() == "still here";
}

TEST(PageServerHostile, ClosesViewersWithMalformedFrames) {
  EchoServer server;
  PageClient other(server.port());
  other.open("secret");
  const std::string close_of_one_byte = PageClient::frame(0x80 | close_frame, "\x03");
  const std::string header_of_masked = std::string("\x81\xff", 2);
  const struct {
    const char* what;
    std::string bytes;
    int code;  ///< of RFC 6455, section 7.4.1
  } cases[] = {
      {"not masked", PageClient::frame(0x80 | text_frame, "hello", false), 1002},
      {"reserved bit 1", PageClient::frame(0xc0 | text_frame, "hello"), 1002},
      {"reserved bit 2", PageClient::frame(0xa0 | text_frame, "hello"), 1002},
      {"reserved bit 3", PageClient::frame(0x90 | text_frame, "hello"), 1002},
      {"reserved kind of message", PageClient::frame(0x83, "hello"), 1002},
      {"reserved kind of control", PageClient::frame(0x8b, "hello"), 1002},
      {"bad UTF-8", PageClient::frame(0x80 | text_frame, "\xff\xfe"), 1007},
      {"a surrogate in UTF-8", PageClient::frame(0x80 | text_frame, "\xed\xa0\x80"), 1007},
      {"UTF-8 that stops", PageClient::frame(0x80 | text_frame, "\xe2\x82"), 1007},
      {"a ping in parts", PageClient::frame(ping_frame, "?"), 1002},
      {"a ping of 126 bytes", PageClient::frame(0x80 | ping_frame, std::string(126, '?')), 1002},
      {"a continuation of nothing", PageClient::frame(0x80 | continuation_frame, "hello"), 1002},
      {"a message within another", PageClient::frame(text_frame, "a") + PageClient::frame(0x80 | text_frame, "b"),
       1002},
      {"2^63 bytes", header_of_masked + std::string("\x80\0\0\0\0\0\0\0", 8) + "mask", 1009},
      {"2^62 bytes", header_of_masked + std::string("\x40\0\0\0\0\0\0\0", 8) + "mask", 1009},
      {"a length that is too long", std::string("\x81\xfe\0\5", 4) + "mask12345", 1002},
      {"a close of one byte", close_of_one_byte, 1002},
      {"a close for a reserved reason", PageClient::frame(0x80 | close_frame, "\x03\xec"), 1002},
      {"a close with bad UTF-8", PageClient::frame(0x80 | close_frame, "\x03\xe8\xff"), 1002},
      {"bytes", PageClient::frame(0x80 | binary_frame, "hello"), 1003},
  };
  int viewers = 1;
  for (const auto& test : cases) {
    PageClient client(server.port());
    ASSERT_EQ(client.open("secret").rfind("HTTP/1.1 101 ", 0), 0u) << test.what;
    ++viewers;
    client.send(test.bytes);
    const auto answer = client.receive_frame();
    ASSERT_TRUE(answer) << test.what;
    EXPECT_EQ(answer->kind, close_frame) << test.what;
    EXPECT_EQ(answer->close_code(), test.code) << test.what;
    client.end_sending();
    client.receive_all();
    EXPECT_TRUE(client.has_ended()) << test.what;
    EXPECT_TRUE(comes_true([&] { return server.closed == viewers - 1; })) << test.what;
    EXPECT_TRUE(is_served(other)) << test.what;
  }
}

TEST(PageServerHostile, ClosesAViewerWhoseMessageIsTooLong) {
  EchoServer server;
  PageClient other(server.port()), whole(server.port()), in_parts(server.port());
  for (PageClient* client : {&other, &whole, &in_parts}) client->open("secret");
  whole.send(PageClient::frame(0x80 | text_frame, std::string((size_t{1} << 20) + 1, 'x')));
  // The rest of the message may make the system discard the answer, so only the end is certain.
  whole.receive_all();
  EXPECT_TRUE(whole.has_ended());
  in_parts.send(PageClient::frame(text_frame, std::string(1000, 'x')));
  for (int i = 0; i < 20'000 && in_parts.send(PageClient::frame(continuation_frame, std::string(1000, 'x'))); ++i) {
  }
  in_parts.receive_all();
  EXPECT_TRUE(in_parts.has_ended());
  EXPECT_TRUE(comes_true([&] { return server.closed == 2; }));
  EXPECT_EQ(server.messages, 0);
  EXPECT_TRUE(is_served(other));
}

TEST(PageServerHostile, DoesNotTakeFramesBeforeTheConnectionIsOpen) {
  EchoServer server;
  PageClient client(server.port());
  client.send(
      "GET /secret/socket HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n" +
      PageClient::frame(0x80 | text_frame, "early"));
  EXPECT_EQ(client.receive_all().rfind("HTTP/1.1 400 ", 0), 0u);
  for (const char* fields : {"Sec-WebSocket-Version: 12\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n",
                             "Sec-WebSocket-Version: 13\r\n", "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: \r\n"})
    EXPECT_EQ(get(server.port(), "/secret/socket",
                  std::string("Host: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n") + fields)
                  .status,
              fields[24] == '2' ? 426 : 400)
        << fields;
  EXPECT_EQ(server.messages, 0);
  EXPECT_EQ(get(server.port(), "/secret/").status, 200);
}

TEST(PageServerHostile, EndsViewersThatDoNotCloseTheirSide) {
  EchoServer server;
  PageClient broken(server.port()), polite(server.port());
  broken.open("secret");
  polite.open("secret");
  broken.send(PageClient::frame(0x83, "hello"));
  polite.send(PageClient::frame(0x80 | close_frame, "\x03\xe8"));
  EXPECT_TRUE(comes_true([&] { return server.closed == 2; }, std::chrono::seconds(10)));
  EXPECT_EQ(server.server->viewers(), 0u);
}

TEST(PageServerHostile, SurvivesGarbage) {
  EchoServer server;
  PageClient other(server.port());
  other.open("secret");
  std::mt19937 random(7);
  const std::string request =
      "GET /secret/save.exr?a=b HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n";
  for (int i = 0; i < 200; ++i) {
    std::string bytes;
    if (i % 2 == 0) {
      bytes.resize(random() % 3000);
      for (char& byte : bytes) byte = static_cast<char>(random());
    } else {
      bytes = request;
      for (unsigned k = random() % 8; k > 0; --k) {
        const size_t at = random() % bytes.size();
        if (random() % 3 == 0) {
          bytes.erase(at, random() % 5);
        } else if (random() % 2 == 0) {
          bytes.insert(at, 1 + random() % 3, static_cast<char>(random()));
        } else {
          bytes[at] = static_cast<char>(random());
        }
        if (bytes.empty()) break;
      }
    }
    PageClient client(server.port());
    client.send(bytes);
    client.end_sending();
    client.receive_all();
    EXPECT_TRUE(client.has_ended()) << i;
  }
  // The same within a viewer.
  for (int i = 0; i < 100; ++i) {
    PageClient client(server.port());
    ASSERT_EQ(client.open("secret").rfind("HTTP/1.1 101 ", 0), 0u);
    std::string bytes(random() % 500, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    if (!bytes.empty() && i % 2 == 0) bytes[0] = static_cast<char>(0x80 | text_frame);
    client.send(bytes);
    client.end_sending();
    client.receive_all();
    EXPECT_TRUE(client.has_ended()) << i;
  }
  EXPECT_TRUE(is_served(other));
  EXPECT_EQ(get(server.port(), "/secret/").status, 200);
  EXPECT_TRUE(comes_true([&] { return server.server->viewers() == 1; }));
}

TEST(PageServerHostile, EndsConnectionsThatSendNoRequest) {
  EchoServer server;
  const auto start = steady_clock::now();
  PageClient silent(server.port()), half(server.port()), slow(server.port());
  half.send("GET /secret/ HTTP/1.1\r\nHost: local");
  std::vector<PageClient> many;
  for (int i = 0; i < 40; ++i) many.emplace_back(server.port());
  std::thread thread([&] {
    for (const char c : std::string("GET /secret/ HTTP/1.1\r\nHost: localhost\r\nX: 12345678901234567890")) {
      if (!slow.send(std::string(1, c))) return;
      std::this_thread::sleep_for(milliseconds(500));
    }
  });
  while (steady_clock::now() - start < std::chrono::seconds(3)) EXPECT_EQ(get(server.port(), "/secret/").status, 200);
  silent.receive_all();
  half.receive_all();
  slow.receive_all();
  EXPECT_TRUE(silent.has_ended() && half.has_ended() && slow.has_ended());
  const auto time = steady_clock::now() - start;
  EXPECT_GT(time, std::chrono::seconds(9));
  EXPECT_LT(time, std::chrono::seconds(19));
  thread.join();
  EXPECT_EQ(get(server.port(), "/secret/").status, 200);
}

TEST(PageServerHostile, WaitsWhileThereAreTooManyConnections) {
  EchoServer server({.max_viewers = 1});
  std::vector<PageClient> many;
  for (int i = 0; i < 65; ++i) many.emplace_back(server.port());
  PageClient next(server.port());
  next.send("GET /secret/ HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_FALSE(next.receive(milliseconds(300)));
  many.clear();
  EXPECT_EQ(next.receive_all().rfind("HTTP/1.1 200 ", 0), 0u);
}

TEST(PageServerHostile, WaitsWhileTheSystemHasNoDescriptors) {
  EchoServer server;
  PageClient client, spare;
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  // All descriptors below the limit are taken.
  std::vector<int> taken;
  const int highest = spare.descriptor() + 20;
  rlimit low = before;
  low.rlim_cur = static_cast<rlim_t>(highest);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &low), 0);
  for (int descriptor = ::open("/dev/null", O_RDONLY); descriptor >= 0; descriptor = ::open("/dev/null", O_RDONLY))
    taken.push_back(descriptor);
  ASSERT_TRUE(client.connect(server.port()));
  client.send("GET /secret/ HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const std::clock_t processor_time = std::clock();
  EXPECT_FALSE(client.receive(milliseconds(1000)));
  const double busy = static_cast<double>(std::clock() - processor_time) / CLOCKS_PER_SEC;
  ::setrlimit(RLIMIT_NOFILE, &before);
  for (const int descriptor : taken) ::close(descriptor);
  EXPECT_LT(busy, 0.3) << "it tries again and again";
  EXPECT_EQ(client.receive_all().rfind("HTTP/1.1 200 ", 0), 0u);
}

TEST(PageServerHostile, CallsThatThrowCostNothing) {
  EchoServer server;
  server.on_message = [](std::string_view text) {
    if (text == "throw") throw std::runtime_error("against the rule");
  };
  PageClient client(server.port());
  client.open("secret");
  client.send_text("throw");
  EXPECT_TRUE(is_served(client));
}

}  // namespace
}  // namespace alhazen::impl

#endif
