// --clamp-indirect: every engine limits the same contributions, and direct light alone is not touched.

#include "parity/engines.h"
#include "parity/scenes.h"

namespace alhazen::impl::test {

namespace {

class IndirectLimit : public ::testing::TestWithParam<std::tuple<std::string, std::string, std::string>> {};

TEST_P(IndirectLimit, HasTheSameBitsByAllEngines) {
  const auto& [name, precision, guiding] = GetParam();
  const Scene& scene = parity_scene(name);
  Settings settings;
  settings.backend = "serial";
  settings.precision = precision;
  settings.samples_per_pixel = guiding == "on" ? 800 : 13;
  settings.width = 11;
  settings.height = 9;
  settings.guiding = guiding;
  settings.clamp_indirect = 0.05;
  const Outcome expected = render_bits(scene, settings);
  visit_engines(settings, [&](const Settings& other) {
    SCOPED_TRACE(other.backend + " " + other.strategy + " " + other.schedule);
    EXPECT_TRUE(same_bits(expected, render_bits(scene, other)));
  });
  Settings free = settings;
  free.clamp_indirect = 0;
  EXPECT_FALSE(same_bits(expected, render_bits(scene, free)));
  // Without indirect light nothing is limited.
  free.max_depth = settings.max_depth = 1;
  free.guiding = settings.guiding = "off";
  EXPECT_TRUE(same_bits(render_bits(scene, settings), render_bits(scene, free)));
}

INSTANTIATE_TEST_SUITE_P(Parity, IndirectLimit,
                         ::testing::Combine(::testing::Values("cornell", "materials", "environments"),
                                            ::testing::Values("float", "double"), ::testing::Values("off", "on")));

}  // namespace

}  // namespace alhazen::impl::test
