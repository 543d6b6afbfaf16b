// What pages ask of a scene, and change of it.

#include "view/session_support.h"

namespace alhazen::impl::test {

TEST(ViewSession, TellsWhatIsUnderAPixel) {
  FakeView view(options_of("cornell.pbrt", 96, 54, 4096));
  view.open(1);
  ASSERT_TRUE(view.wait_for_frame(1, is_any));  // so the scene has been read
  view.send(1, {{"type", "pick"}, {"x", 48}, {"y", 50}, {"id", 7}});
  const auto picked = view.wait_for_text(1, [](const json& j) { return j["type"] == "picked"; });
  ASSERT_TRUE(picked);
  EXPECT_EQ(picked->json["id"], 7);
  EXPECT_TRUE(picked->json["object"].is_string());
  EXPECT_TRUE(picked->json["instance"].is_null());
  EXPECT_NE(picked->json["where"].get<std::string>().find("cornell.pbrt:"), std::string::npos) << picked->json;
  EXPECT_EQ(picked->json["material_name"], "white");
  EXPECT_EQ(picked->json["kind"], "Diffuse");
  EXPECT_EQ(picked->json["fields"][0]["name"], "reflectance");
  EXPECT_EQ(picked->json["fields"][0]["kind"], "colour");
  EXPECT_EQ(picked->json["fields"][0]["value"], json({0.725, 0.71, 0.68}));
  EXPECT_NEAR(picked->json["position"][1].get<double>(), 0, 1);  // the floor
  view.send(1, {{"type", "pick"}, {"x", 96}, {"y", 50}, {"id", 8}});
  EXPECT_TRUE(view.wait_for_text(1, [](const json& j) { return j["type"] == "error"; }));
}

TEST(ViewSession, MaterialsAreChanged) {
  const ViewOptions options = options_of("cornell.pbrt");
  FakeView view(options);
  view.open(1);
  want(view, 1, {"color"});
  const auto first = view.wait_for_frame(1, is_final);
  ASSERT_TRUE(first);
  view.send(1, {{"type", "material"}, {"material", 0}, {"values", {{"reflectance", {0.9, 0.1, 0.2}}}}});
  const auto changes = view.wait_for_text(1, [](const json& j) { return j["type"] == "changes"; });
  ASSERT_TRUE(changes);
  ASSERT_EQ(changes->json["changes"].size(), 1u);
  EXPECT_NE(changes->json["changes"][0].get<std::string>().find("-> (0.9, 0.1, 0.2)"), std::string::npos)
      << changes->json;
  // A page that opens now is told of it, and sees what the library renders of such a scene.
  ::alhazen::Scene scene = ::alhazen::Scene::load(options.scene, options.load);
  ::alhazen::Material material = scene.material(scene.materials()[0]);
  std::get<::alhazen::Diffuse>(material.bsdf).reflectance = ::alhazen::Colour{0.9, 0.1, 0.2};
  scene.set(scene.materials()[0], material);
  const RenderedImage expected = ::alhazen::render(scene, options.settings);
  view.open(2);
  want(view, 2, {"color"});
  EXPECT_TRUE(view.wait_for_text(2, [](const json& j) { return j["type"] == "changes"; }));
  ASSERT_TRUE(view.wait_for_frame(2, [&](const json& h) { return is_final(h) && h["view"] > first->json["view"]; }));
  view.open(3, false);
  want(view, 3, {"color"});
  // What it is sent before it acknowledges is whole, as the first in single precision is.
  const auto whole = view.wait_for_frame(3, is_any);
  ASSERT_TRUE(whole);
  view.send(3, {{"type", "ack"}, {"frame", whole->json["frame"]}});
  const auto exact = view.wait_for_frame(3, [](const json& h) { return h["type"] == "float"; });
  ASSERT_TRUE(exact);
  ASSERT_TRUE(exact->json["tiles"].is_null() && is_final(exact->json));
  expect_same_bits(decode_frame(exact->message), expected);
  view.send(1, {{"type", "material"}, {"material", 0}, {"values", {{"shine", 1.0}}}});
  EXPECT_TRUE(view.wait_for_text(1, [](const json& j) { return j["type"] == "error"; }));
  view.send(1, {{"type", "material"}, {"material", 99}, {"values", {{"reflectance", 1.0}}}});
  EXPECT_TRUE(view.wait_for_text(1, [](const json& j) {
    return j["type"] == "error" && j["message"].get<std::string>().starts_with("material: there are ");
  }));
}

}  // namespace alhazen::impl::test
