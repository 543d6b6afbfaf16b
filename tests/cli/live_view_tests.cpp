// render --view: a read-only page of a render under way, by the messages that its page exchanges with the program.

#include <bit>
#include <cmath>
#include <future>
#include <thread>

#include "cli/fixture.h"
#include "support/web_socket.h"
#include "view/frame_decoder.h"

namespace alhazen::impl::test {

namespace {

using nlohmann::json;

const std::string endless = "10000000";

/// What a page has been told.
class Page {
 public:
  explicit Page(const PageAddress& address) : socket_(address) { send({{"type", "hello"}}); }

  void send(const json& message) { socket_.send(message.dump()); }

  /// Reads until `is_enough`, and acknowledges frames. Returns false at the end of the connection.
  bool read_until(const std::function<bool()>& is_enough) {
    while (!is_enough()) {
      const std::optional<WebSocket::Message> message = socket_.receive();
      if (!message) return false;
      take(*message);
    }
    return true;
  }

  json scene, status, last_error;
  std::vector<std::string> logs;
  std::vector<DecodedFrame> frames;
  std::map<std::string, std::vector<std::vector<uint32_t>>> planes;  ///< by layer, with the tiles of all frames

 private:
  void take(const WebSocket::Message& message) {
    if (message.is_binary) {
      DecodedFrame frame = decode_frame(message.payload);
      auto& kept = planes[frame.header["layer"]];
      if (kept.empty() || frame.header["tiles"].is_null() || frame.header["type"] != last_type_[frame.header["layer"]])
        kept = frame.planes;
      else
        add_tiles(frame, kept);
      last_type_[frame.header["layer"]] = frame.header["type"];
      send({{"type", "ack"}, {"frame", frame.header["frame"]}});
      frames.push_back(std::move(frame));
      return;
    }
    const json text = json::parse(message.payload);
    if (text["type"] == "scene") scene = text;
    if (text["type"] == "status") status = text;
    if (text["type"] == "error") last_error = text;
    if (text["type"] == "log") logs.push_back(text["message"]);
  }

  static void add_tiles(const DecodedFrame& frame, std::vector<std::vector<uint32_t>>& kept) {
    const size_t width = frame.header["width"], height = frame.header["height"], tile = frame.header["tile"];
    const size_t columns = (width + tile - 1) / tile;
    for (const size_t index : frame.tiles)
      for (size_t y = index / columns * tile; y < std::min(height, (index / columns + 1) * tile); ++y)
        for (size_t x = index % columns * tile; x < std::min(width, (index % columns + 1) * tile); ++x)
          for (size_t c = 0; c < kept.size(); ++c) kept[c][y * width + x] = frame.planes[c][y * width + x];
  }

  WebSocket socket_;
  std::map<std::string, json> last_type_;
};

class LiveView : public Command {
 protected:
  /// Renders with --view, and calls `visit` on a thread of its own as soon as the address is printed.
  CommandResult render_seen(const std::vector<std::string>& arguments,
                            const std::function<void(const PageAddress&)>& visit) {
    CommandOptions options;
    std::future<void> visitor;
    options.signal_when = [&](const std::string& err) {
      if (!visitor.valid() && err.find("/\n", err.find("view: ")) != std::string::npos)
        visitor = std::async(std::launch::async, [&, address = page_address(err)] { visit(address); });
      return 0;
    };
    std::vector<std::string> all = arguments;
    all.insert(all.end(), {"--view", "--progress", "json"});
    const CommandResult result = render(all, options);
    if (visitor.valid()) visitor.get();
    is_absent_ = result.err.find("libboost-dev") != std::string::npos;
    return result;
  }

  bool is_absent_ = false;  ///< the server was not built
};

#define SKIP_WITHOUT_SERVER() \
  if (is_absent_) GTEST_SKIP() << "built without the server of pages"

/// All frames are of the image so far, and the last one has the bits of the file.
TEST_F(LiveView, ShowsTheImageToItsEnd) {
  std::vector<double> samples;
  json scene, status, refusal;
  std::map<std::string, std::vector<std::vector<uint32_t>>> planes;
  const CommandResult result =
      render_seen({"-o", "a.exr", "--spp", endless, "--time-limit", "4", "--exr-type", "float", "--aov", "normal,depth",
                   "--exposure", "1", "--tone-map", "aces"},
                  [&](const PageAddress& address) {
                    Page page(address);
                    page.send({{"type", "layers"}, {"layers", {"color", "normal"}}, {"exact", true}});
                    page.send({{"type", "reset"}});
                    page.read_until([&] {
                      return !page.frames.empty() && page.frames.back().header["final"] == true &&
                             page.planes.contains("normal") && page.frames.back().header["layer"] == "normal";
                    });
                    for (const DecodedFrame& frame : page.frames)
                      if (frame.header["layer"] == "color") samples.push_back(frame.header["samples"]);
                    scene = page.scene;
                    status = page.status;
                    refusal = page.last_error;
                    planes = page.planes;
                  });
  SKIP_WITHOUT_SERVER();
  ASSERT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_TRUE(scene["read_only"]);
  EXPECT_EQ(scene["name"], "a.exr");
  EXPECT_EQ(scene["size"], (json{24, 24}));
  EXPECT_EQ(scene["exposure"], 1.0);
  EXPECT_EQ(scene["tone_map"], "aces");
  EXPECT_EQ(scene["layers"][1], (json{{"name", "normal"}, {"channels", {"normal.X", "normal.Y", "normal.Z"}}}));
  EXPECT_EQ(scene["layers"].size(), 3u);
  ASSERT_GE(samples.size(), 3u);
  EXPECT_TRUE(std::is_sorted(samples.begin(), samples.end()));
  EXPECT_GT(status["seconds"], 0.5);
  EXPECT_EQ(status["viewers"], 1);
  EXPECT_EQ(status["samples_total"], 10000000);
  EXPECT_GT(status["remaining"], 0);
  EXPECT_GT(status["error"], 0);
  EXPECT_GE(status["curve"].size(), 1u);
  EXPECT_NE(refusal["message"].get<std::string>().find("does not change it"), std::string::npos) << refusal;
  EXPECT_FALSE(refusal["fatal"]);
  const Image file = image("a.exr");
  for (const auto& [layer, channels] : std::map<std::string, std::vector<std::string>>{
           {"color", {"R", "G", "B"}}, {"normal", {"normal.X", "normal.Y", "normal.Z"}}})
    for (size_t c = 0; c < 3; ++c) {
      const std::vector<float>& expected = file.planes.at(static_cast<size_t>(file.channel(channels[c])));
      ASSERT_EQ(planes[layer][c].size(), expected.size());
      for (size_t i = 0; i < expected.size(); ++i)
        ASSERT_EQ(planes[layer][c][i], std::bit_cast<uint32_t>(expected[i])) << channels[c] << " " << i;
    }
}

TEST_F(LiveView, StopsAsCtrlCDoes) {
  const CommandResult result = render_seen({"-o", "a.exr", "--spp", endless}, [](const PageAddress& address) {
    Page page(address);
    ASSERT_TRUE(page.read_until([&] { return !page.frames.empty(); }));
    page.send({{"type", "stop"}});
    page.read_until([] { return false; });
    EXPECT_EQ(page.frames.back().header["final"], true);
    EXPECT_EQ(page.status["activity"], "done");
  });
  SKIP_WITHOUT_SERVER();
  EXPECT_EQ(result.exit_code, 130) << result.everything();
  EXPECT_LT(result.seconds, 30);
  EXPECT_NE(result.err.find("interrupted: the image has the samples so far"), std::string::npos) << result.err;
  EXPECT_TRUE(exists("a.exr"));
}

TEST_F(LiveView, SavesTheImageSoFar) {
  const CommandResult result =
      render_seen({"-o", "a.exr", "-o", "a.png", "--spp", endless}, [&](const PageAddress& address) {
        Page page(address);
        ASSERT_TRUE(page.read_until([&] { return !page.frames.empty(); }));
        EXPECT_FALSE(exists("a.exr"));
        page.send({{"type", "save"}});
        ASSERT_TRUE(page.read_until([&] { return page.logs.size() >= 2; }));
        EXPECT_EQ(page.logs[0].find("wrote a.exr with "), 0u) << page.logs[0];
        EXPECT_EQ(page.logs[1].find("wrote a.png with "), 0u) << page.logs[1];
        EXPECT_EQ(image("a.exr").width, 24);
        EXPECT_TRUE(exists("a.png"));
        page.send({{"type", "stop"}});
        page.read_until([] { return false; });
      });
  SKIP_WITHOUT_SERVER();
  EXPECT_EQ(result.exit_code, 130) << result.everything();
}

/// Neither one that says nothing, nor one that acknowledges nothing, nor one that is gone keeps the render.
TEST_F(LiveView, ViewersThatDoNotReadDoNotKeepTheRender) {
  const CommandResult result = render_seen({"-o", "a.exr", "--spp", endless, "--time-limit", "3", "--size", "300x300"},
                                           [](const PageAddress& address) {
                                             WebSocket silent(address), deaf(address);
                                             deaf.send(R"({"type":"hello"})");
                                             deaf.send(R"({"type":"layers","layers":["color"],"exact":true})");
                                             for (int i = 0; i < 20; ++i) {
                                               Page page(address);
                                               page.read_until([&] { return !page.scene.is_null(); });
                                             }
                                             std::this_thread::sleep_for(std::chrono::seconds(4));
                                           });
  SKIP_WITHOUT_SERVER();
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_LT(result.seconds, 20);
  EXPECT_TRUE(exists("a.exr"));
}

TEST_F(LiveView, ShowsOneFrameAfterTheOther) {
  std::set<std::string> names;
  const CommandResult result =
      render_seen({"-o", "f_#.exr", "--turntable", "3", "--spp", "2000"}, [&](const PageAddress& address) {
        Page page(address);
        bool has_saved = false;
        page.read_until([&] {
          if (!page.scene.is_null()) names.insert(page.scene["name"]);
          if (!page.frames.empty() && !std::exchange(has_saved, true)) page.send({{"type", "save"}});
          return names.size() == 3;
        });
        EXPECT_EQ(page.logs, std::vector<std::string>{
                                 "nothing is written before the end: frames, pipes and devices get finished images"});
      });
  SKIP_WITHOUT_SERVER();
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_EQ(names, (std::set<std::string>{"f_0.exr", "f_1.exr", "f_2.exr"}));
}

TEST_F(LiveView, ChangesNoBitsAndTakesPortsOnly) {
  ASSERT_EQ(render({"-o", "a.pfm", "--spp", "150"}).exit_code, 0);
  const CommandResult result = render_seen({"-o", "b.pfm", "--spp", "150"}, [](const PageAddress&) {});
  SKIP_WITHOUT_SERVER();
  ASSERT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_EQ(image("a.pfm").planes, image("b.pfm").planes);
  for (const char* wrong : {"-1", "65536", "here", "80x"}) {
    const CommandResult refused = render({"-o", "c.exr", std::string("--view=") + wrong});
    EXPECT_EQ(refused.exit_code, 2) << wrong;
    EXPECT_NE(refused.err.find("--view must be a port"), std::string::npos) << refused.err;
  }
  EXPECT_FALSE(exists("c.exr"));
}

}  // namespace

}  // namespace alhazen::impl::test
