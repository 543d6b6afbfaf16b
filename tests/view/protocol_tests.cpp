#include "view/protocol.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "util/diagnostics.h"

namespace alhazen::impl::test {

namespace {

template <class Message>
Message parsed(const std::string& text) {
  return std::get<Message>(parse_page_message(text));
}

std::string refusal(const std::string& text) {
  try {
    parse_page_message(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string camera_text(const std::string& changed, const std::string& value) {
  nlohmann::json camera{{"position", {0, 1, 5}}, {"target", {0, 0, 0}}, {"up", {0, 1, 0}}, {"fov", 40},
                        {"aperture", 0},         {"focus", nullptr}};
  if (!changed.empty()) camera[changed] = nlohmann::json::parse(value);
  return nlohmann::json{{"type", "camera"}, {"camera", camera}, {"moving", true}, {"id", 9}}.dump();
}

}  // namespace

TEST(Protocol, MessagesOfPagesAreRead) {
  EXPECT_NO_THROW(parsed<HelloMessage>(R"({"type":"hello"})"));
  const auto layers = parsed<LayersMessage>(R"({"type":"layers","layers":["color","depth"],"exact":true})");
  EXPECT_EQ(layers.layers, (std::vector<std::string>{"color", "depth"}));
  EXPECT_TRUE(layers.exact);
  EXPECT_EQ(parsed<AckMessage>(R"({"type":"ack","frame":12})").frame, 12u);
  const auto camera = parsed<CameraMessage>(camera_text("focus", "2.5"));
  EXPECT_EQ(camera.camera.position, (::alhazen::Vec3{0, 1, 5}));
  EXPECT_EQ(camera.camera.fov, 40);
  EXPECT_EQ(camera.camera.focus, 2.5);
  EXPECT_TRUE(camera.moving);
  EXPECT_EQ(camera.id, 9u);
  EXPECT_FALSE(parsed<CameraMessage>(camera_text("fov", "null")).camera.fov);
  EXPECT_NO_THROW(parsed<ResetMessage>(R"({"type":"reset"})"));
  EXPECT_EQ(parsed<SelectCameraMessage>(R"({"type":"select_camera","camera":2})").camera, 2u);
  EXPECT_EQ(parsed<SizeMessage>(R"({"type":"size","width":640,"height":360})").height, 360);
  EXPECT_EQ(parsed<SamplesMessage>(R"({"type":"samples","samples":256})").samples, 256);
  EXPECT_TRUE(parsed<PauseMessage>(R"({"type":"pause","paused":true})").paused);
  EXPECT_TRUE(parsed<DenoiseMessage>(R"({"type":"denoise","on":true})").on);
  EXPECT_EQ(
      parsed<EnvironmentMessage>(R"({"type":"environment","rotation":30,"strength":2,"light_scale":0.5})").rotation,
      30);
  EXPECT_EQ(parsed<PickMessage>(R"({"type":"pick","x":3,"y":4,"id":5})").y, 4);
  const auto material = parsed<MaterialMessage>(
      R"({"type":"material","material":1,"values":{"roughness":0.3,"thin":true,"base_colour":[1,0.5,0]}})");
  EXPECT_EQ(std::get<double>(material.values.at("roughness")), 0.3);
  EXPECT_TRUE(std::get<bool>(material.values.at("thin")));
  EXPECT_EQ((std::get<std::array<double, 3>>(material.values.at("base_colour"))[1]), 0.5);
  EXPECT_EQ(parsed<TimeMessage>(R"({"type":"time","time":1.5})").time, 1.5);
  EXPECT_NO_THROW(parsed<StopMessage>(R"({"type":"stop"})"));
  EXPECT_NO_THROW(parsed<SaveMessage>(R"({"type":"save"})"));
}

TEST(Protocol, WhatIsNoMessageIsRefusedInOneSentence) {
  const std::pair<std::string, const char*> cases[] = {
      {"", "not JSON"},
      {"{", "not JSON"},
      {"\xff\xfe", "not JSON"},
      {R"({"type":"ack","frame":1} x)", "not JSON"},
      {"[]", "must be an object"},
      {"1", "must be an object"},
      {"{}", "needs the field 'type'"},
      {R"({"type":1})", "'type' must be a text"},
      {R"({"type":"dance"})", "no message of the type 'dance'"},
      {R"({"type":")" + std::string(5000, 'x') + "\"}", "no message of the type"},
      {R"({"type":"hello","more":1})", "hello has no field 'more'"},
      {R"({"type":"ack"})", "ack needs the field 'frame'"},
      {R"({"type":"ack","frame":-1})", "whole number"},
      {R"({"type":"ack","frame":1.5})", "whole number"},
      {R"({"type":"ack","frame":"1"})", "whole number"},
      {R"({"type":"ack","frame":1e400})", "not JSON"},
      {R"({"type":"layers","layers":"color","exact":false})", "array"},
      {R"({"type":"layers","layers":[1],"exact":false})", "names"},
      {R"({"type":"layers","layers":[],"exact":0})", "true or false"},
      {R"({"type":"layers","layers":[)" + std::string(100, ' ') + R"("a")" +
           [] {
             std::string more;
             for (int i = 0; i < 40; ++i) more += R"(,"a")";
             return more;
           }() +
           R"(],"exact":false})",
       "at most 32"},
      {R"({"type":"camera","moving":true,"id":1})", "needs the field 'camera'"},
      {R"({"type":"camera","camera":7,"moving":true,"id":1})", "camera must be an object"},
      {camera_text("position", "[1,2]"), "three numbers"},
      {camera_text("position", "[1,2,\"3\"]"), "'position' must be"},
      {camera_text("position", "[1,2,1e30]"), "'position' must be"},
      {camera_text("position", "[0,0,0]"), "'target' must not be"},
      {camera_text("up", "[0,0,0]"), "'up' must be a direction"},
      {camera_text("up", "[0,1,5]"), "parallel"},
      {camera_text("fov", "0"), "between 0"},
      {camera_text("fov", "180"), "between 0"},
      {camera_text("fov", "true"), "'fov' must be"},
      {camera_text("aperture", "-1"), "'aperture' must be"},
      {camera_text("aperture", "null"), "'aperture' must be"},
      {camera_text("focus", "0"), "'focus' must be"},
      {camera_text("roll", "0"), "camera has no field 'roll'"},
      {R"({"type":"size","width":0,"height":1})", "'width' must be"},
      {R"({"type":"size","width":100000,"height":100000})", "pixels"},
      {R"({"type":"samples","samples":0})", "'samples' must be"},
      {R"({"type":"pause","paused":1})", "true or false"},
      {R"({"type":"environment","rotation":0,"strength":-1,"light_scale":1})", "'strength' must be"},
      {R"({"type":"pick","x":-1,"y":0,"id":1})", "'x' must be"},
      {R"({"type":"material","material":0,"values":[]})", "'values' must be an object"},
      {R"({"type":"material","material":0,"values":{"roughness":"high"}})", "'roughness' must be"},
      {R"({"type":"material","material":0,"values":{"base_colour":[1,2]}})", "three numbers"},
      {R"({"type":"time","time":null})", "'time' must be"},
      {R"({"type":"hello","x":[[[[[[[[[[1]]]]]]]]]]})", "nested too deeply"},
      {R"({"type":"hello","x":")" + std::string(70000, 'x') + "\"}", "longer than"},
  };
  for (const auto& [text, expected] : cases) {
    const std::string message = refusal(text);
    EXPECT_NE(message.find(expected), std::string::npos) << text.substr(0, 100) << "\n" << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_LT(message.size(), 200u) << message;
  }
}

TEST(Protocol, MessagesOfTheProgramAreJson) {
  SceneText scene;
  scene.name = "a\"b\xff";  // names of files need not be UTF-8
  scene.layers = {{"color", {"R", "G", "B"}}};
  scene.animation = {0, 2, 24};
  const nlohmann::json json = nlohmann::json::parse(scene_message(scene));
  EXPECT_EQ(json["type"], "scene");
  EXPECT_EQ(json["layers"][0]["channels"][2], "B");
  EXPECT_EQ(json["animation"]["end"], 2);
  EXPECT_TRUE(json["environment"].is_null());
  StatusText status;
  status.curve = {{4, 0.5}, {8, 0.25}};
  const nlohmann::json told = nlohmann::json::parse(status_message(status));
  EXPECT_EQ(told["curve"][1][1], 0.25);
  EXPECT_TRUE(told["remaining"].is_null());
  const nlohmann::json camera = nlohmann::json::parse(camera_message({{0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 40, 0, {}}, 7));
  EXPECT_EQ(camera["id"], 7);
  EXPECT_TRUE(camera["camera"]["focus"].is_null());
  // What the program sends of a camera, it reads.
  EXPECT_EQ(parsed<CameraMessage>(
                nlohmann::json{{"type", "camera"}, {"camera", camera["camera"]}, {"moving", false}, {"id", 1}}.dump())
                .camera.position,
            (::alhazen::Vec3{0, 0, 1}));
}

}  // namespace alhazen::impl::test
