#include "view/view_session.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include "alhazen/read_image.h"
#include "view/half_bits.h"
#include "view/session_support.h"

namespace alhazen::impl::test {

TEST(ViewSession, ShowsThePictureThatTheLibraryRenders) {
  const ViewOptions options = options_of("cornell.pbrt");
  FakeView view(options);
  view.open(1);
  want(view, 1, {"color"});
  const auto last = view.wait_for_frame(1, [](const json& h) { return is_final(h) && h["type"] == "float"; });
  ASSERT_TRUE(last);
  EXPECT_EQ(last->json["samples"], 8);
  EXPECT_EQ(last->json["step"], 1);
  const auto all = view.sender.sent(1);
  const auto scene =
      std::find_if(all.begin(), all.end(), [](const auto& s) { return s.json.value("type", "") == "scene"; });
  ASSERT_NE(scene, all.end());
  EXPECT_EQ(scene->json["size"], json({96, 54}));
  EXPECT_EQ(scene->json["samples"], 8);
  // Frames may be of changed tiles alone; one that is asked for anew is whole.
  view.open(2, false);
  want(view, 2, {"color"});
  const auto whole = view.wait_for_frame(2, is_any);
  ASSERT_TRUE(whole);
  view.send(2, {{"type", "ack"}, {"frame", whole->json["frame"]}});
  const auto exact = view.wait_for_frame(2, [](const json& h) { return h["type"] == "float"; });
  ASSERT_TRUE(exact);
  ASSERT_TRUE(exact->json["tiles"].is_null());
  expect_same_bits(decode_frame(exact->message), rendered(options, {}));
}

TEST(ViewSession, StatusSaysHowFarItIs) {
  FakeView view(options_of("cornell.pbrt", 96, 54, 64));
  view.open(1);
  const auto done =
      view.wait_for_text(1, [](const json& j) { return j["type"] == "status" && j["activity"] == "done"; });
  ASSERT_TRUE(done);
  EXPECT_EQ(done->json["samples"], 64);
  EXPECT_EQ(done->json["samples_total"], 64);
  EXPECT_EQ(done->json["viewers"], 1);
  EXPECT_GT(done->json["seconds"], 0);
  ASSERT_FALSE(done->json["error"].is_null());
  EXPECT_GT(done->json["error"], 0);
  EXPECT_FALSE(done->json["curve"].empty());
  std::optional<Clock::time_point> last;
  for (const auto& sent : view.sender.sent(1)) {
    if (sent.json.value("type", "") != "status") continue;
    if (last) {
      EXPECT_GT(sent.at - *last, std::chrono::milliseconds(80));
    }
    last = sent.at;
  }
}

TEST(ViewSession, TheLastOfManyCamerasIsSeen) {
  const ViewOptions options = options_of("cornell.pbrt");
  FakeView view(options);
  view.open(1);
  ASSERT_TRUE(view.wait_for_frame(1, is_any));
  for (int i = 0; i < 500; ++i) {
    view.send_camera(1, camera_at(0.01 * i), i < 499, static_cast<uint64_t>(i));
    if (i % 50 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  const auto last = view.wait_for_frame(1, [](const json& h) { return is_final(h) && h["camera_id"] == 499; });
  ASSERT_TRUE(last);
  EXPECT_EQ(last->json["samples"], 8);
  uint64_t view_number = 0;
  for (const auto& sent : view.sender.sent(1)) {
    if (!sent.is_frame) continue;
    EXPECT_GE(sent.json["view"], view_number) << "an older view after a later one";
    view_number = sent.json["view"];
    EXPECT_GT(sent.json["samples"], 0);
  }
  EXPECT_LT(view_number, 400u) << "cameras queue up";
  view.open(2, false);
  want(view, 2, {"color"});
  const auto first = view.wait_for_frame(2, is_any);
  ASSERT_TRUE(first);
  EXPECT_TRUE(first->json["camera_id"].is_null()) << "it is not this viewer's";
  view.send(2, {{"type", "ack"}, {"frame", first->json["frame"]}});
  const auto exact = view.wait_for_frame(2, [](const json& h) { return h["type"] == "float"; });
  ASSERT_TRUE(exact);
  expect_same_bits(decode_frame(exact->message), rendered(options, camera_at(0.01 * 499)));
}

TEST(ViewSession, FramesAreSeenWhileTheCameraMoves) {
  FakeView view(options_of("cornell.pbrt", 320, 180, 1024));
  view.open(1);
  ASSERT_TRUE(view.wait_for_frame(1, is_any));
  const size_t before = view.sender.sent(1).size();
  for (int i = 0; i < 60; ++i) {
    view.send_camera(1, camera_at(0.02 * i), true, static_cast<uint64_t>(i));
    std::this_thread::sleep_for(std::chrono::milliseconds(16));
  }
  std::set<uint64_t> views;
  const auto sent = view.sender.sent(1);
  for (size_t i = before; i < sent.size(); ++i)
    if (sent[i].is_frame) views.insert(sent[i].json["view"].get<uint64_t>());
  EXPECT_GE(views.size(), 5u);
}

TEST(ViewSession, OthersAreToldOfTheCamera) {
  FakeView view(options_of("cornell.pbrt"));
  view.open(1);
  view.open(2);
  ASSERT_TRUE(view.wait_for_text(2, [](const json& j) { return j["type"] == "camera"; }));
  ASSERT_TRUE(view.wait_for_text(1, [](const json& j) { return j["type"] == "camera"; }));
  ASSERT_TRUE(view.wait_for_frame(1, is_final));
  const size_t before = view.sender.sent(1).size();
  view.send_camera(1, camera_at(1), false, 7);
  const auto told = view.wait_for_text(2, [](const json& j) {
    return j["type"] == "camera" && j["camera"]["position"] == json({6 * std::sin(1.0), 1.5, 6 * std::cos(1.0)});
  });
  EXPECT_TRUE(told);
  ASSERT_TRUE(view.wait_for_frame(1, [](const json& h) { return is_final(h) && h["camera_id"] == 7; }));
  const auto own = view.sender.sent(1);
  for (size_t i = before; i < own.size(); ++i) EXPECT_NE(own[i].json.value("type", ""), "camera");
  const size_t at_reset = own.size();
  view.send(1, {{"type", "reset"}});
  EXPECT_TRUE(view.wait_for_text(
      1, [](const json& j) { return j["type"] == "camera"; }, at_reset));
}

TEST(ViewSession, LayersAreThoseOfTheLibrary) {
  const ViewOptions options = options_of("spheres.pbrt", 80, 60, 8);
  FakeView view(options);
  view.open(1);
  ASSERT_TRUE(view.wait_for_frame(1, is_final));
  want(view, 1, {"color", "depth", "normal", "object"});
  ASSERT_TRUE(view.wait_for_frame(1, [](const json& h) { return h["layer"] == "object" && is_final(h); }));
  const RenderedImage image = rendered(options, {}, {"depth", "normal", "object"});
  // A viewer that comes now is sent whole frames.
  view.open(2, false);
  const auto colour = view.wait_for_frame(2, is_any);
  ASSERT_TRUE(colour);
  want(view, 2, {"depth", "normal", "object"});
  view.send(2, {{"type", "ack"}, {"frame", colour->json["frame"]}});
  for (const char* layer : {"depth", "normal", "object"}) {
    const auto frame =
        view.wait_for_frame(2, [&](const json& h) { return h["layer"] == layer && h["type"] == "float"; });
    ASSERT_TRUE(frame) << layer;
    ASSERT_TRUE(frame->json["tiles"].is_null());
    ASSERT_TRUE(is_final(frame->json));
    expect_same_bits(decode_frame(frame->message), image);
  }
}

TEST(ViewSession, DenoisedPicturesAreThoseOfTheLibrary) {
  ViewOptions options = options_of("cornell.pbrt", 64, 48, 8);
  FakeView view(options);
  view.open(1);
  ASSERT_TRUE(view.wait_for_frame(1, is_final));
  view.send(1, {{"type", "denoise"}, {"on", true}});
  want(view, 1, {"color", "denoised"});
  const auto frame = view.wait_for_frame(1, [](const json& h) { return h["layer"] == "denoised"; });
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->json["samples"], 8);
  EXPECT_TRUE(is_final(frame->json));
  options.settings.denoiser = "auto";
  expect_same_bits(decode_frame(frame->message), rendered(options, {}));
  // Of the next camera, too; and none when it is off.
  view.send_camera(1, camera_at(1), false, 3);
  ASSERT_TRUE(view.wait_for_frame(
      1, [&](const json& h) { return h["layer"] == "denoised" && h["view"] > frame->json["view"]; }));
  view.send(1, {{"type", "denoise"}, {"on", false}});
  const size_t before = view.sender.sent(1).size();
  view.send_camera(1, camera_at(2), false, 4);
  ASSERT_TRUE(view.wait_for_frame(
      1, [](const json& h) { return h["layer"] == "color" && is_final(h); }, before));
  const auto sent = view.sender.sent(1);
  for (size_t i = before; i < sent.size(); ++i) EXPECT_NE(sent[i].json.value("layer", ""), "denoised");
}

TEST(ViewSession, UnknownLayersAndMessagesAreErrorsOfTheirViewer) {
  FakeView view(options_of("cornell.pbrt"));
  view.open(1);
  view.open(2);
  want(view, 1, {"colour"});
  const auto error = view.wait_for_text(1, [](const json& j) { return j["type"] == "error"; });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->json["message"], "layers: there is no layer 'colour'");
  EXPECT_FALSE(error->json["fatal"]);
  const size_t before = view.sender.sent(1).size();
  view.send(1, {{"type", "select_camera"}, {"camera", 3}});
  EXPECT_TRUE(view.wait_for_text(
      1, [](const json& j) { return j["type"] == "error"; }, before));
  ASSERT_TRUE(view.wait_for_frame(1, is_final));
  for (const auto& sent : view.sender.sent(2)) EXPECT_NE(sent.json.value("type", ""), "error");
}

TEST(ViewSession, NothingIsSentToAViewerThatAcknowledgesNothing) {
  FakeView view(options_of("cornell.pbrt"));
  view.open(1, false);
  view.open(2);
  ASSERT_TRUE(view.wait_for_frame(2, is_final));
  for (int i = 0; i < 20; ++i) {
    const size_t before = view.sender.sent(2).size();
    view.send_camera(2, camera_at(0.1 * i), false, 1);
    ASSERT_TRUE(view.wait_for_frame(2, is_any, before));
  }
  size_t frames = 0;
  for (const auto& sent : view.sender.sent(1)) frames += sent.is_frame ? 1 : 0;
  EXPECT_EQ(frames, 1u);
  // Its next is the newest.
  ASSERT_TRUE(view.wait_for_frame(2, is_final));
  const auto all = view.sender.sent(1);
  const auto frame = std::find_if(all.begin(), all.end(), [](const auto& s) { return s.is_frame; });
  view.send(1, {{"type", "ack"}, {"frame", frame->json["frame"]}});
  const auto next = view.wait_for_frame(1, [&](const json& h) { return h["frame"] != frame->json["frame"]; });
  ASSERT_TRUE(next);
  EXPECT_GE(next->json["view"], 20);
}

TEST(ViewSession, PauseKeepsWhatIsThere) {
  FakeView view(options_of("cornell.pbrt", 96, 54, 100'000));
  view.open(1);
  ASSERT_TRUE(view.wait_for_frame(1, [](const json& h) { return h["samples"] >= 4; }));
  view.send(1, {{"type", "pause"}, {"paused", true}});
  ASSERT_TRUE(view.wait_for_text(1, [](const json& j) { return j["type"] == "status" && j["activity"] == "paused"; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(1000));
  const size_t before = view.sender.sent(1).size();
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  const auto sent = view.sender.sent(1);
  for (size_t i = before; i < sent.size(); ++i) EXPECT_FALSE(sent[i].is_frame);
  // A camera is seen nevertheless, in full resolution, but no more.
  view.send_camera(1, camera_at(1), false, 5);
  const auto seen = view.wait_for_frame(1, [](const json& h) { return h["camera_id"] == 5 && h["step"] == 1; });
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->json["samples"], 1);
  const size_t at_rest = view.sender.sent(1).size();
  view.send(1, {{"type", "pause"}, {"paused", false}});
  EXPECT_TRUE(view.wait_for_frame(
      1, [](const json& h) { return h["samples"] >= 4; }, at_rest));
}

TEST(ViewSession, SizeAndSamplesChange) {
  const ViewOptions options = options_of("cornell.pbrt");
  FakeView view(options);
  view.open(1);
  ASSERT_TRUE(view.wait_for_frame(1, is_final));
  view.send(1, {{"type", "size"}, {"width", 65}, {"height", 47}});
  const auto resized = view.wait_for_frame(1, [](const json& h) { return is_final(h) && h["width"] == 65; });
  ASSERT_TRUE(resized);
  EXPECT_EQ(resized->json["full_height"], 47);
  view.send(1, {{"type", "samples"}, {"samples", 16}});
  ASSERT_TRUE(view.wait_for_frame(1, [](const json& h) { return is_final(h) && h["samples"] == 16; }));
  const size_t before = view.sender.sent(1).size();
  view.send(1, {{"type", "samples"}, {"samples", 5}});
  const auto fewer = view.wait_for_frame(1, is_final, before);
  ASSERT_TRUE(fewer);
  EXPECT_EQ(fewer->json["samples"], 5);
}

TEST(ViewSession, CoarsePicturesCoverTheCroppedWhole) {
  ViewOptions options = options_of("cornell.pbrt", 100, 75);
  options.settings.pixel_bounds = {10, 77, 20, 61};
  FakeView view(options);
  view.open(1);
  const auto last = view.wait_for_frame(1, is_final);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->json["x"], 10);
  EXPECT_EQ(last->json["width"], 67);
  view.open(2);
  view.send_camera(2, camera_at(0.3), false, 1);
  ASSERT_TRUE(view.wait_for_frame(2, [](const json& h) { return is_final(h) && h["camera_id"] == 1; }));
  for (const ViewerId viewer : {ViewerId{1}, ViewerId{2}})
    for (const auto& sent : view.sender.sent(viewer)) {
      if (!sent.is_frame) continue;
      const int step = sent.json["step"];
      EXPECT_EQ(sent.json["width"], (67 + step - 1) / step);
      EXPECT_EQ(sent.json["height"], (41 + step - 1) / step);
      EXPECT_EQ(sent.json["x"], 10);
      EXPECT_EQ(sent.json["y"], 20);
      EXPECT_EQ(sent.json["full_width"], 100);
    }
}

TEST(ViewSession, SavesThePicture) {
  const ViewOptions options = options_of("cornell.pbrt");
  FakeView view(options);
  view.open(1);
  ASSERT_TRUE(view.wait_for_frame(1, is_final));
  const PageResponse exr = view.get("save.exr");
  ASSERT_EQ(exr.status, 200) << exr.body;
  EXPECT_EQ(exr.file_name, "cornell.exr");
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "alhazen_view_session_tests.exr";
  std::ofstream(file, std::ios::binary) << exr.body;
  const RenderedImage saved = ::alhazen::read_image(file.string());
  std::filesystem::remove(file);
  EXPECT_EQ(saved.width, 96);
  EXPECT_NE(exr.body.find("samples"), std::string::npos) << "the header has metadata";
  const RenderedImage image = rendered(options, {});
  for (const char* channel : {"R", "G", "B"})
    for (size_t i = 0; i < 96 * 54; ++i)
      ASSERT_EQ(half_bits(saved.plane(channel)[i]), half_bits(image.plane(channel)[i])) << channel << " " << i;
  const PageResponse png = view.get("save.png", "exposure=-1.5&tone_map=agx");
  ASSERT_EQ(png.status, 200) << png.body;
  EXPECT_EQ(png.body.substr(1, 3), "PNG");
  EXPECT_NE(view.get("save.png", "exposure=0").body, png.body);
  EXPECT_EQ(view.get("save.png", "exposure=bright").status, 400);
  EXPECT_EQ(view.get("save.png", "tone_map=warm").status, 400);
  EXPECT_EQ(view.get("save.png", "depth=16").status, 400);
  EXPECT_EQ(view.get("save.gif").status, 404);
  EXPECT_EQ(view.get("../save.png").status, 404);
}

TEST(ViewSession, ASceneThatFailsIsAnErrorOfThePage) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "alhazen_view_session_tests.pbrt";
  std::ofstream(file) << "WorldBegin\nShape \"sphere\" \"float radius\" [\n";
  ViewOptions options = options_of("");
  options.scene = file.string();
  std::string expected;
  try {
    ::alhazen::Scene::load(options.scene);
  } catch (const ::alhazen::InputError& error) {
    expected = error.what();
  }
  ASSERT_FALSE(expected.empty());
  std::string reported;
  std::mutex mutex;
  options.report = [&](const std::string& line) {
    const std::lock_guard lock(mutex);
    reported = line;
  };
  FakeView view(options);
  view.open(1);
  const auto error = view.wait_for_text(1, [](const json& j) { return j["type"] == "error"; });
  ASSERT_TRUE(error);
  EXPECT_TRUE(error->json["fatal"]);
  EXPECT_EQ(error->json["message"], expected);
  view.open(2);
  EXPECT_TRUE(view.wait_for_text(2, [](const json& j) { return j["type"] == "error" && j["fatal"] == true; }));
  EXPECT_TRUE(view.wait_for_text(2, [](const json& j) { return j["type"] == "status" && j["activity"] == "failed"; }));
  view.send_camera(1, camera_at(0), false, 1);
  EXPECT_EQ(view.get("save.png").status, 503);
  std::filesystem::remove(file);
  const std::lock_guard lock(mutex);
  EXPECT_EQ(reported, expected);
}

TEST(ViewSession, EndsAtAnyMoment) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    FakeView view(options_of("cornell.pbrt", 160, 90, 1024));
    const auto wait = [&](int most) {
      std::this_thread::sleep_for(std::chrono::microseconds(std::uniform_int_distribution<>(0, most)(random)));
    };
    wait(20'000);
    view.open(1);
    wait(20'000);
    view.send_camera(1, camera_at(i), i % 2 == 0, 1);
    if (i % 3 == 0) want(view, 1, {"color", "depth"});
    wait(40'000);
  }
}

/// Prints how soon there are pictures of ALHAZEN_VIEW_SCENE, at 960 x 540.
TEST(ViewSession, Latency) {
  const char* const scene = std::getenv("ALHAZEN_VIEW_SCENE");
  if (!scene) GTEST_SKIP() << "ALHAZEN_VIEW_SCENE names no scene";
  ViewOptions options = options_of("", 960, 540, 1024);
  options.scene = scene;
  FakeView view(options);
  const auto start = Clock::now();
  const auto ms = [](auto duration) { return std::chrono::duration<double, std::milli>(duration).count(); };
  view.open(1);
  const auto told = view.wait_for_text(1, [](const json& j) { return j["type"] == "camera"; });
  ASSERT_TRUE(told);
  const json first = told->json["camera"];
  const auto picture = view.wait_for_frame(1, is_any);
  ASSERT_TRUE(picture);
  std::printf("first picture after %.0f ms, of it %.0f ms to read\n", ms(picture->at - start), ms(told->at - start));
  std::this_thread::sleep_for(std::chrono::milliseconds(3000));
  const auto opened = Clock::now();
  view.open(2);
  const auto other = view.wait_for_frame(2, is_any);
  std::printf("a page that opens then has one after %.0f ms\n", ms(other->at - opened));
  view.close(2);
  for (uint64_t id = 1; id <= 8; ++id) {
    json camera = first;
    camera["position"][0] = first["position"][0].get<double>() + 0.001 * static_cast<double>(id);
    const auto sent = Clock::now();
    view.send(1, {{"type", "camera"}, {"camera", camera}, {"moving", false}, {"id", id}});
    const auto seen = view.wait_for_frame(1, [&](const json& h) { return h["camera_id"] == id; });
    ASSERT_TRUE(seen);
    std::printf("camera %d: %.0f ms, step %d;", static_cast<int>(id), ms(seen->at - sent),
                seen->json["step"].get<int>());
    for (int step = seen->json["step"].get<int>() / 2; step >= 1 && id == 8; step /= 2) {
      const auto finer =
          view.wait_for_frame(1, [&](const json& h) { return h["camera_id"] == id && h["step"] == step; });
      std::printf(" step %d %.0f ms, %zu bytes;", step, ms(finer->at - sent), finer->message.size());
    }
    std::printf("\n");
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
  }
  const auto passes = view.wait_for_frame(1, [&](const json& h) { return h["camera_id"] == 8 && h["samples"] >= 4; });
  ASSERT_TRUE(passes);
  const size_t before = view.sender.sent(1).size();
  const auto drag = Clock::now();
  for (uint64_t id = 100; id < 220; ++id) {
    json camera = first;
    camera["position"][0] = first["position"][0].get<double>() + 0.001 * static_cast<double>(id);
    view.send(1, {{"type", "camera"}, {"camera", camera}, {"moving", true}, {"id", id}});
    std::this_thread::sleep_for(std::chrono::milliseconds(16));
  }
  std::set<uint64_t> views;
  const double seconds = ms(Clock::now() - drag) / 1000;
  const auto sent = view.sender.sent(1);
  for (size_t i = before; i < sent.size(); ++i)
    if (sent[i].is_frame) views.insert(sent[i].json["view"].get<uint64_t>());
  std::printf("%.1f pictures a second while the camera moves\n", static_cast<double>(views.size()) / seconds);
}

TEST(ViewSession, ViewersComeAndGo) {
  FakeView view(options_of("cornell.pbrt", 160, 90, 100'000));
  std::vector<std::thread> threads;
  for (ViewerId thread = 0; thread < 4; ++thread)
    threads.emplace_back([&, thread] {
      for (ViewerId i = 0; i < 12; ++i) {
        const ViewerId viewer = 1 + 100 * thread + i;
        view.open(viewer, i % 3 != 0);
        view.send_camera(viewer, camera_at(static_cast<double>(viewer)), i % 2 == 0, i);
        want(view, viewer, i % 4 == 0 ? std::vector<std::string>{"color", "albedo"} : std::vector<std::string>{"color"},
             i % 2 == 0);
        EXPECT_TRUE(view.wait_for_frame(viewer, is_any)) << viewer;
        view.close(viewer);
      }
    });
  for (std::thread& thread : threads) thread.join();
  view.open(1000);
  const auto status =
      view.wait_for_text(1000, [](const json& j) { return j["type"] == "status" && j["viewers"] == 1; });
  EXPECT_TRUE(status);
}

}  // namespace alhazen::impl::test
