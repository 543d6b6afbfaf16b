// What is sent to tev, against a server that checks every packet.

#include "view/tev_client.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "support/tev_server.h"
#include "util/diagnostics.h"
#include "view/tev_packets.h"

namespace alhazen::impl::test {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

Image layered_image(int width, int height, float first) {
  Image image{width, height, {"R", "G", "B", "A", "normal.X", "normal.Y", "normal.Z", "depth.Z"}, {}};
  const size_t pixels = static_cast<size_t>(width) * static_cast<size_t>(height);
  for (size_t c = 0; c < image.channels.size(); ++c) {
    std::vector<float> plane(pixels);
    for (size_t i = 0; i < pixels; ++i) plane[i] = first + static_cast<float>(c * pixels + i);
    image.planes.push_back(std::move(plane));
  }
  return image;
}

TevAddress address_of(const TevServer& server) { return parse_tev_address(server.address()); }

void expect_image(TevServer& server, const std::string& name, const Image& expected) {
  server.wait_for_end();
  server.with_images([&](const TevImages& tev) {
    ASSERT_TRUE(tev.images.contains(name)) << name;
    const Image& image = tev.images.at(name);
    EXPECT_EQ(image.width, expected.width);
    EXPECT_EQ(image.height, expected.height);
    EXPECT_EQ(image.channels, expected.channels);
    EXPECT_EQ(image.planes, expected.planes);
  });
}

/// Byte by byte, as the README of tev and its sources describe them.
TEST(TevPackets, AreThoseOfTheProtocol) {
  const Image image{2, 3, {"R", "depth.Z"}, {{1, 2, 3, 4, 5, 6}, {7, 8, 9, 10, 11, 12}}};
  const TevPacket create = tev_create_image("a.exr", image);
  const std::string expected(
      "\x22\0\0\0"
      "\x04"
      "\x01"
      "a.exr\0"
      "\x02\0\0\0"
      "\x03\0\0\0"
      "\x02\0\0\0"
      "R\0"
      "depth.Z\0",
      4 + 1 + 1 + 6 + 12 + 2 + 8);
  EXPECT_EQ(std::string(create.head.begin(), create.head.end()), expected);
  EXPECT_TRUE(create.parts.empty());

  const TevPacket update = tev_update_image("a.exr", image, 1, 3);
  ASSERT_EQ(update.parts.size(), 2u);
  EXPECT_EQ(std::vector<float>(update.parts[0].begin(), update.parts[0].end()), (std::vector<float>{3, 4, 5, 6}));
  EXPECT_EQ(std::vector<float>(update.parts[1].begin(), update.parts[1].end()), (std::vector<float>{9, 10, 11, 12}));
  TevReader reader(std::string_view(update.head.data(), update.head.size()));
  EXPECT_EQ(reader.number<uint32_t>(), update.head.size() + 8 * sizeof(float));
  EXPECT_EQ(reader.number<uint8_t>(), 6);
  EXPECT_FALSE(reader.flag());
  EXPECT_EQ(reader.text(), "a.exr");
  EXPECT_EQ(reader.number<int32_t>(), 2);
  EXPECT_EQ(reader.texts(2), image.channels);
  for (const int number : {0, 1, 2, 2}) EXPECT_EQ(reader.number<int32_t>(), number);
  for (const int64_t number : {0, 4, 1, 1}) EXPECT_EQ(reader.number<int64_t>(), number);
  EXPECT_EQ(reader.left(), 0u);
}

TEST(TevPackets, FitTheBufferThatTevBeginsWith) {
  for (const int width : {1, 24, 1920, 8000}) {
    const Image image = layered_image(width, 40, 0);
    const int rows = tev_rows_per_packet(image);
    ASSERT_GE(rows, 1);
    ASSERT_LE(rows, 40);
    EXPECT_LT(tev_update_image("name", image, 0, rows).size(), size_t{1} << 20) << width;
  }
  const Image wide = layered_image(100'000, 1, 0);
  EXPECT_EQ(tev_rows_per_packet(wide), 1) << "then tev makes its buffer larger";
}

TEST(TevAddress, IsHostAndPort) {
  const auto parsed = [](const std::string& text) {
    const TevAddress address = parse_tev_address(text);
    return address.host + " " + std::to_string(address.port);
  };
  EXPECT_EQ(parsed("127.0.0.1:14158"), "127.0.0.1 14158");
  EXPECT_EQ(parsed("127.0.0.1:14158"), TevAddress{}.host + " " + std::to_string(TevAddress{}.port));
  EXPECT_EQ(parsed("desk.example.org:99"), "desk.example.org 99");
  EXPECT_EQ(parsed("desk"), "desk 14158");
  EXPECT_EQ(parsed(":15000"), "127.0.0.1 15000");
  EXPECT_EQ(parsed("[::1]:15000"), "::1 15000");
  EXPECT_EQ(parsed("[fe80::1%eth0]"), "fe80::1%eth0 14158");
  EXPECT_EQ(parsed("::1"), "::1 14158");
  EXPECT_EQ(parse_tev_address("[::1]:15000").to_string(), "[::1]:15000");
  for (const char* wrong : {"", "desk:", "desk:0", "desk:65536", "desk:-1", "desk:1x", "[::1", "[]:1", "[::1]1",
                            "[::1]:", "a b:1", "a/b:1"})
    EXPECT_THROW(parse_tev_address(wrong), InputError) << wrong;
}

TEST(TevClient, SendsAllChannelsWithTheirBits) {
  for (const bool is_ipv6 : {false, true}) {
    TevServer server({.is_ipv6 = is_ipv6});
    Image image = layered_image(37, 1500, 0.5f);
    image.planes[0][5] = std::nanf("");
    image.planes[1][5] = -std::numeric_limits<float>::infinity();
    {
      TevClient client(address_of(server));
      client.show("out/a picture.exr", Image(image));
      client.flush();
      EXPECT_EQ(client.take_problem(), "");
      EXPECT_GT(client.take_seconds(), 0.0);
    }
    server.wait_for_end();
    server.with_images([&](const TevImages& tev) {
      ASSERT_EQ(tev.images.size(), 1u);
      const Image& got = tev.images.at("out/a picture.exr");
      for (size_t c = 0; c < image.planes.size(); ++c)
        EXPECT_EQ(0, std::memcmp(got.planes[c].data(), image.planes[c].data(), image.planes[c].size() * sizeof(float)));
      EXPECT_EQ(tev.selected, "out/a picture.exr");
    });
  }
}

TEST(TevClient, MakesAnImageOnceAndUpdatesIt) {
  TevServer server;
  const Image last = layered_image(20, 10, 9);
  {
    TevClient client(address_of(server));
    for (int i = 0; i < 10; ++i) {
      client.show("one", i == 9 ? Image(last) : layered_image(20, 10, static_cast<float>(i)));
      client.flush();
    }
    client.show("two", layered_image(5, 5, 3));
    client.flush();
  }
  expect_image(server, "one", last);
  expect_image(server, "two", layered_image(5, 5, 3));
  server.with_images([](const TevImages& tev) {
    EXPECT_EQ(tev.created.at("one"), 1);
    EXPECT_EQ(tev.finished.at("one"), 10);
    EXPECT_EQ(tev.created.at("two"), 1);
  });
  EXPECT_EQ(server.connections(), 1);
}

TEST(TevClient, OfManyImagesSendsTheLast) {
  TevServer server;
  const Image last = layered_image(300, 300, -1);
  {
    TevClient client(address_of(server));
    for (int i = 0; i < 200; ++i) client.show("many", layered_image(300, 300, static_cast<float>(i)));
    client.show("many", Image(last));
    client.flush();
  }
  expect_image(server, "many", last);
}

/// A port on which nobody listens.
int closed_port() {
  const TevServer server;
  return server.port();
}

TEST(TevClient, SaysOnceThatNoneIsThere) {
  TevClient client({"127.0.0.1", closed_port()});
  const Clock::time_point start = Clock::now();
  for (int i = 0; i < 3; ++i) {
    client.show("a", layered_image(8, 8, 0));
    client.flush(5);
  }
  EXPECT_LT(seconds_since(start), 2) << "a refusal is not waited for";
  const std::string problem = client.take_problem();
  EXPECT_NE(problem.find("cannot be reached"), std::string::npos) << problem;
  EXPECT_NE(problem.find("127.0.0.1"), std::string::npos) << problem;
  EXPECT_EQ(client.take_problem(), "");
}

TEST(TevClient, SaysThatANameIsUnknown) {
  TevClient client({"no-such-host.invalid", 14158});
  client.show("a", layered_image(8, 8, 0));
  client.flush(30);
  const std::string problem = client.take_problem();
  EXPECT_NE(problem.find("is not found"), std::string::npos) << problem;
}

TEST(TevClient, FindsATevThatIsStartedLater) {
  const int port = closed_port();
  TevClient client({"127.0.0.1", port});
  client.show("late", layered_image(8, 8, 0));
  client.flush();
  EXPECT_NE(client.take_problem(), "");
  // The port of the server below is another one, so a socket on the first one passes on what comes.
  const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<uint16_t>(port));
  const int again = 1;
  ::setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &again, sizeof(again));
  ASSERT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  ASSERT_EQ(::listen(listener, 1), 0);
  const Clock::time_point start = Clock::now();
  pollfd waiting{listener, POLLIN, 0};
  while (::poll(&waiting, 1, 100) == 0 && seconds_since(start) < 20) client.show("late", layered_image(8, 8, 1));
  EXPECT_GT(waiting.revents, 0) << "it was not tried again";
  ::close(listener);
}

/// Whatever a tev does, the caller is not kept: neither by show, nor for long at the end.
TEST(TevClient, IsNotKeptByOneThatReadsNothing) {
  TevServer server({.reads = false});
  Clock::time_point start = Clock::now();
  {
    TevClient client(address_of(server));
    for (int i = 0; i < 30; ++i) {
      const Clock::time_point shown = Clock::now();
      Image image = layered_image(800, 600, static_cast<float>(i));  // 15 MB, more than sockets hold
      const double made = seconds_since(shown);
      client.show("stuck", std::move(image));
      EXPECT_LT(seconds_since(shown) - made, 0.5);
    }
    start = Clock::now();
    client.flush(0.5);
    EXPECT_LT(seconds_since(start), 1.5);
    start = Clock::now();
  }
  EXPECT_LT(seconds_since(start), 2.5);
}

TEST(TevClient, GoesOnWhenOneClosesAtAnyMoment) {
  std::mt19937 random(7);
  const Image image = layered_image(100, 100, 1);  // 320 kB
  for (int i = 0; i < 20; ++i) {
    const size_t bytes = std::uniform_int_distribution<size_t>(0, 700'000)(random);
    TevServer server({.closes_after = bytes});
    TevClient client(address_of(server));
    const Clock::time_point start = Clock::now();
    for (int k = 0; k < 4; ++k) {
      client.show("closed", Image(image));
      client.flush();
    }
    EXPECT_LT(seconds_since(start), 8) << bytes;
    server.with_images([](const TevImages&) {});
  }
}

}  // namespace

}  // namespace alhazen::impl::test
