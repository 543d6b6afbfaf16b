// Viewers by WebSocket: messages in both directions, those that do not read, and the end of the server.

#ifdef ALHAZEN_WITH_VIEW_SERVER

#include <gtest/gtest.h>

#include <algorithm>
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

milliseconds since(steady_clock::time_point start) {
  return std::chrono::duration_cast<milliseconds>(steady_clock::now() - start);
}

std::shared_ptr<const std::string> bytes_of(size_t size, char value) {
  return std::make_shared<const std::string>(size, value);
}

std::ptrdiff_t open_files() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator());
}

bool is_open(const std::string& header) { return header.rfind("HTTP/1.1 101 ", 0) == 0; }

TEST(PageServerViewers, ExchangesMessages) {
  EchoServer server;
  PageClient client(server.port());
  const std::string header = client.open("secret");
  ASSERT_TRUE(is_open(header)) << header;
  // RFC 6455, section 1.3
  EXPECT_NE(header.find("Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n"), std::string::npos) << header;
  for (const std::string& text : {std::string("hello"), std::string(), std::string("Größe 😀"), std::string(200, 'a'),
                                  std::string(70'000, 'b'), std::string(size_t{1} << 20, 'c')}) {
    client.send_text(text);
    EXPECT_EQ(client.receive_message(), text) << text.size();
  }
  // One message of three frames, with a ping between them.
  client.send(PageClient::frame(text_frame, "one ") + PageClient::frame(continuation_frame, "two ") +
              PageClient::frame(0x80 | ping_frame, "?") + PageClient::frame(0x80 | continuation_frame, "three"));
  const auto pong = client.receive_frame();
  ASSERT_TRUE(pong);
  EXPECT_EQ(pong->kind, pong_frame);
  EXPECT_EQ(pong->payload, "?");
  EXPECT_EQ(client.receive_message(), "one two three");
  EXPECT_EQ(server.server->viewers(), 1u);
  client.send(PageClient::frame(0x80 | close_frame, "\x03\xe8"));
  const auto end = client.receive_frame();
  ASSERT_TRUE(end);
  EXPECT_EQ(end->close_code(), 1000);
  EXPECT_TRUE(comes_true([&] { return server.closed == 1; }));
  EXPECT_EQ(server.server->viewers(), 0u);
  EXPECT_EQ(server.opened, 1);
}

TEST(PageServerViewers, KeepsTheOrderOfMessages) {
  EchoServer server;
  PageClient client(server.port());
  ASSERT_TRUE(is_open(client.open("secret")));
  ASSERT_TRUE(comes_true([&] { return server.opened == 1; }));
  // Text and bytes, from small to longer than a frame, faster than they are sent.
  constexpr size_t count = 400;
  for (size_t i = 0; i < count; ++i) {
    std::string text = std::to_string(i) + ' ' + std::string(i % 7 == 0 ? 600'000 : i, 'x');
    const auto message = std::make_shared<const std::string>(std::move(text));
    if (i % 2 == 0) {
      server.server->send_text(server.last, message);
    } else {
      server.server->send_binary(server.last, message);
    }
  }
  for (size_t i = 0; i < count; ++i) {
    const auto message = client.receive_message();
    ASSERT_TRUE(message) << i;
    EXPECT_EQ(message->size(), std::to_string(i).size() + 1 + (i % 7 == 0 ? 600'000 : i));
    EXPECT_EQ(std::stoul(*message), i);
  }
  EXPECT_TRUE(comes_true([&] { return server.server->queued_bytes(server.last) == 0; }));
}

TEST(PageServerViewers, MarksTextAndBytes) {
  EchoServer server;
  PageClient client(server.port());
  ASSERT_TRUE(is_open(client.open("secret")));
  ASSERT_TRUE(comes_true([&] { return server.opened == 1; }));
  server.server->send_binary(server.last, bytes_of(300'000, '\xff'));
  server.server->send_text(server.last, bytes_of(3, 'a'));
  const auto first = client.receive_frame(), rest = client.receive_frame(), text = client.receive_frame();
  ASSERT_TRUE(first && rest && text);
  EXPECT_EQ(first->kind, binary_frame);
  EXPECT_FALSE(first->is_last);
  EXPECT_EQ(rest->kind, continuation_frame);
  EXPECT_EQ(first->payload.size() + rest->payload.size(), 300'000u);
  EXPECT_EQ(text->kind, text_frame);
}

TEST(PageServerViewers, IsOpenToItsOwnPageAlone) {
  const EchoServer server;
  const std::string port = std::to_string(server.port());
  for (const std::string& origin :
       {std::string("http://evil.example"), std::string("null"), std::string(), "https://localhost:" + port,
        "http://localhost:" + port + "0", std::string("http://localhost"), "http://localhost:" + port + ".evil.example",
        "http://127.0.0.1:" + port})
    EXPECT_NE(PageClient(server.port())
                  .open("secret", "Host: localhost:" + port + "\r\nOrigin: " + origin + "\r\n")
                  .find(" 403 "),
              std::string::npos)
        << origin;
  for (const std::string& host :
       {"localhost:" + port, "127.0.0.1:" + port, "LocalHost:" + port, std::string("[::1]:9")})
    EXPECT_TRUE(
        is_open(PageClient(server.port()).open("secret", "Host: " + host + "\r\nOrigin: http://" + host + "\r\n")))
        << host;
  const std::string twice = "Host: localhost\r\nOrigin: http://localhost\r\nOrigin: http://evil.example\r\n";
  EXPECT_FALSE(is_open(PageClient(server.port()).open("secret", twice)));
  EXPECT_NE(PageClient(server.port()).open("wrong").find(" 403 "), std::string::npos);
  EXPECT_NE(PageClient(server.port()).open("secret", "Host: evil.example\r\n").find(" 403 "), std::string::npos);
}

TEST(PageServerViewers, LetsInNoMoreThanItMay) {
  EchoServer server({.max_viewers = 2});
  PageClient first(server.port()), second(server.port());
  ASSERT_TRUE(is_open(first.open("secret")));
  ASSERT_TRUE(is_open(second.open("secret")));
  PageClient third(server.port());
  EXPECT_NE(third.open("secret").find(" 503 "), std::string::npos);
  EXPECT_NE(third.receive_all().find("There are 2 viewers already"), std::string::npos);
  EXPECT_EQ(get(server.port(), "/secret/").status, 200);
  first.close();
  ASSERT_TRUE(comes_true([&] { return server.closed == 1; }));
  PageClient fourth(server.port());
  EXPECT_TRUE(is_open(fourth.open("secret")));
}

TEST(PageServerViewers, ManyComeAndGo) {
  EchoServer server({.max_viewers = 50});
  std::vector<std::thread> threads;
  std::atomic<int> echoes{0};
  constexpr int clients = 50, visits = 6;
  for (int i = 0; i < clients; ++i) {
    threads.emplace_back([&, i] {
      std::mt19937 random(static_cast<unsigned>(i));
      for (int visit = 0; visit < visits; ++visit) {
        PageClient client(server.port());
        // Who has just gone may still be counted.
        if (!is_open(client.open("secret"))) {
          --visit;
          continue;
        }
        const std::string text = std::to_string(i) + ":" + std::to_string(visit) + std::string(random() % 3000, '.');
        for (int k = 0; k < 5; ++k) {
          client.send_text(text);
          if (client.receive_message() == text) ++echoes;
        }
        if (random() % 2 == 0) client.send(PageClient::frame(0x80 | close_frame, "\x03\xe9"));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(echoes, clients * visits * 5);
  EXPECT_TRUE(comes_true([&] { return server.closed == clients * visits; })) << server.closed;
  EXPECT_EQ(server.opened, clients * visits);
  EXPECT_EQ(server.server->viewers(), 0u);
}

TEST(PageServerViewers, DropsOneThatDoesNotReadAndHoldsUpNobody) {
  constexpr size_t limit = size_t{8} << 20, size = size_t{1} << 20;
  EchoServer server({.max_queued_bytes = limit});
  PageClient reader(server.port()), idler(server.port());
  ASSERT_TRUE(is_open(idler.open("secret")));
  ASSERT_TRUE(comes_true([&] { return server.opened == 1; }));
  const ViewerId idle = server.last;
  ASSERT_TRUE(is_open(reader.open("secret")));
  ASSERT_TRUE(comes_true([&] { return server.opened == 2; }));
  const ViewerId reading = server.last;

  constexpr int count = 60;
  std::atomic<int> received{0};
  std::thread thread([&] {
    while (const auto message = reader.receive_message()) {
      if (message->size() != size || (*message)[0] != static_cast<char>('A' + received)) return;
      if (++received == count) return;
    }
  });
  steady_clock::duration longest{};
  size_t most_queued = 0;
  for (int i = 0; i < count; ++i) {
    const auto message = bytes_of(size, static_cast<char>('A' + i));
    for (const ViewerId viewer : {idle, reading}) {
      const auto start = steady_clock::now();
      server.server->send_binary(viewer, message);
      longest = std::max(longest, steady_clock::now() - start);
    }
    most_queued = std::max(most_queued, server.server->queued_bytes(idle));
    comes_true([&] { return server.server->queued_bytes(reading) < limit / 2; });
  }
  thread.join();
  EXPECT_EQ(received, count);
  EXPECT_TRUE(comes_true([&] { return server.closed == 1; })) << "the one that does not read is still there";
  EXPECT_EQ(server.server->queued_bytes(idle), 0u);
  EXPECT_GT(most_queued, limit / 2);
  EXPECT_LE(most_queued, limit + size) << "with the message that is being sent";
  // Threads of other programs may stop this one; the 60 MB that wait for the reader take longer all together.
  EXPECT_LT(since(steady_clock::now() - longest), milliseconds(200));
  RecordProperty("longest_send_us",
                 static_cast<int>(std::chrono::duration_cast<std::chrono::microseconds>(longest).count()));
  EXPECT_EQ(server.server->viewers(), 1u);
  server.server->send_binary(idle, bytes_of(1, 'x'));  // of one that is gone, nothing
}

TEST(PageServerViewers, SendsOneMessageThatIsLargerThanTheLimit) {
  EchoServer server({.max_queued_bytes = 1000});
  PageClient client(server.port());
  ASSERT_TRUE(is_open(client.open("secret")));
  ASSERT_TRUE(comes_true([&] { return server.opened == 1; }));
  server.server->send_binary(server.last, bytes_of(size_t{30} << 20, 'x'));
  const auto message = client.receive_message();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->size(), size_t{30} << 20);
}

TEST(PageServerViewers, MayBeSentToFromManyThreads) {
  EchoServer server;
  PageClient client(server.port());
  ASSERT_TRUE(is_open(client.open("secret")));
  ASSERT_TRUE(comes_true([&] { return server.opened == 1; }));
  constexpr int senders = 4, each = 500;
  std::vector<std::thread> threads;
  for (int sender = 0; sender < senders; ++sender) {
    threads.emplace_back([&, sender] {
      for (int i = 0; i < each; ++i)
        server.server->send_text(server.last,
                                 std::make_shared<const std::string>(std::to_string(sender) + ' ' + std::to_string(i)));
    });
  }
  std::vector<int> next(senders, 0);
  for (int i = 0; i < senders * each; ++i) {
    const auto message = client.receive_message();
    ASSERT_TRUE(message);
    int& expected = next[static_cast<size_t>(std::stoi(*message))];
    EXPECT_EQ(std::stoi(message->substr(2)), expected);
    ++expected;
  }
  for (std::thread& thread : threads) thread.join();
}

TEST(PageServerViewers, AreToldThatTheServerEnds) {
  EchoServer server;
  PageClient client(server.port());
  ASSERT_TRUE(is_open(client.open("secret")));
  ASSERT_TRUE(comes_true([&] { return server.opened == 1; }));
  server.server->send_text(server.last, bytes_of(100'000, 'x'));
  const auto start = steady_clock::now();
  std::thread thread([&] { server.stop(); });
  EXPECT_EQ(client.receive_message(), std::string(100'000, 'x')) << "what was sent before";
  const auto end = client.receive_frame();
  ASSERT_TRUE(end);
  EXPECT_EQ(end->close_code(), 1001);
  client.send(PageClient::frame(0x80 | close_frame, "\x03\xe9"));
  thread.join();
  EXPECT_LT(since(start), milliseconds(5000));
  EXPECT_EQ(server.closed, 0) << "nothing is called while the server is destroyed";
}

TEST(PageServerViewers, DoNotDelayTheEndOfTheServer) {
  EchoServer server;
  PageClient idler(server.port()), half_open(server.port()), downloading(server.port()), waiting(server.port());
  ASSERT_TRUE(is_open(idler.open("secret")));
  ASSERT_TRUE(comes_true([&] { return server.opened == 1; }));
  server.server->send_binary(server.last, bytes_of(size_t{30} << 20, 'x'));
  half_open.send("GET /secret/");
  downloading.send("GET /secret/large HTTP/1.1\r\nHost: localhost\r\n\r\n");
  ASSERT_TRUE(downloading.receive());
  waiting.send("GET /secret/slow HTTP/1.1\r\nHost: localhost\r\n\r\n");
  ASSERT_TRUE(comes_true([&] { return server.is_slow_one_running.load(); }));
  const auto start = steady_clock::now();
  server.stop();
  EXPECT_LT(since(start), milliseconds(3000)) << "half a second for those that do not read, and for what is running";
}

TEST(PageServerViewers, TheServerEndsAtAnyMomentAndLeavesNothing) {
  const auto before = open_files();
  std::mt19937 random(1);
  for (int round = 0; round < 40; ++round) {
    EchoServer server;
    const int port = server.port();
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([port, i] {
        for (int k = 0; k < 5; ++k) {
          PageClient client;
          if (!client.connect(port)) return;
          if (i == 0) {
            client.send("GET /secret/slow HTTP/1.1\r\nHost: localhost\r\n\r\n");
            client.receive(milliseconds(20));
            return;
          }
          if (i == 1) {
            client.send("GET /secret/large HTTP/1.1\r\nHost: localhost\r\n\r\n");
            client.receive(milliseconds(20));
            continue;
          }
          if (!is_open(client.open("secret"))) continue;
          for (int m = 0; m < 20 && client.send_text(std::string(5000, 'x')); ++m) {
          }
          if (i == 2) client.receive(milliseconds(5));
        }
      });
    }
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 20'000));
    server.stop();
    for (std::thread& thread : threads) thread.join();
  }
  EXPECT_EQ(open_files(), before);
}

}  // namespace
}  // namespace alhazen::impl

#endif
