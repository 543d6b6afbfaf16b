// Messages to programs name fields of Settings, not options of the command line.

#include "api/option_names.h"

#include <gtest/gtest.h>

#include "alhazen/rays.h"
#include "render/setting_table.h"
#include "scene_support.h"

namespace alhazen::test {

namespace {

std::string header_text() {
  const impl::test::Bytes bytes = impl::test::read_file(ALHAZEN_SOURCE_DIR "/include/alhazen/alhazen.h");
  return {bytes.begin(), bytes.end()};
}

TEST(OptionNames, EveryOptionOfTheTableIsAFieldOfSettings) {
  const std::string header = header_text();
  const std::string settings = header.substr(header.find("struct Settings {"), header.find("struct Progress {"));
  for (const impl::SettingEntry& entry : impl::setting_table()) {
    const std::string field = impl::field_of_option(entry.name);
    if (std::string_view(entry.name) == "size") {
      EXPECT_EQ(field, "width' and 'height");
      continue;
    }
    const bool is_member = settings.find(" " + field + ";") != std::string::npos ||
                           settings.find(" " + field + "{") != std::string::npos ||
                           settings.find(" " + field + " =") != std::string::npos;
    EXPECT_TRUE(is_member) << entry.name << " -> " << field;
  }
}

TEST(OptionNames, AreReplacedInMessages) {
  EXPECT_EQ(impl::with_field_names("--fov must be a number"), "'fov' must be a number");
  EXPECT_EQ(impl::with_field_names("give --spp and --precision double, (--resume)"),
            "give 'samples_per_pixel' and 'precision' double, ('resume')");
  for (const char* message : {"give --unknown", "a--fov", "'--fov'", "--", ""})
    EXPECT_EQ(impl::with_field_names(message), message);
}

TEST(OptionNames, OfErrorsOfRenders) {
  Scene scene;
  scene.add(alhazen::Shape{Sphere{1}, {}});
  Settings settings = quick_settings();
  settings.fov = 500;
  EXPECT_TRUE(error_of([&] { render(scene, settings); }).starts_with("'fov' must be"));
  settings = quick_settings();
  settings.look_at = {1, 2};
  EXPECT_TRUE(error_of([&] { render(scene, settings); }).starts_with("'look_at' must"));
  settings = quick_settings();
  settings.threads = -1;
  EXPECT_TRUE(error_of([&] { RayQueries(scene, settings); }).starts_with("'threads' must be"));
}

TEST(OptionNames, OfWarnings) {
  Scene scene;
  scene.add(alhazen::Shape{Sphere{1}, {}});
  scene.add(PointLight{10, {0, 3, 0}});
  Settings settings = quick_settings();
  settings.environment_strength = 2;
  const RenderedImage image = render(scene, settings);
  ASSERT_EQ(image.warnings.size(), 1u);
  EXPECT_EQ(image.warnings[0].message, "'environment_strength' has no effect: the scene has no infinite light");
}

}  // namespace

}  // namespace alhazen::test
