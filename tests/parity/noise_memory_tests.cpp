// A noise target where memory for its estimate is short: the render goes on without decisions.

#include <cstdlib>
#include <new>

#include "parity/scenes.h"

namespace {

/// Allocations of this size by this thread fail; 0: none.
thread_local size_t refused_size = 0;

void* allocate(size_t size) {
  if (size != 0 && size == refused_size) throw std::bad_alloc();
  if (void* const memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

// They replace those of all tests of this program.
void* operator new(size_t size) { return allocate(size); }
void* operator new[](size_t size) { return allocate(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, size_t) noexcept { std::free(memory); }

namespace alhazen::impl::test {

namespace {

TEST(NoiseMemory, AnEstimateThatFailsIsAWarningAndDecidesNothing) {
  Settings settings;
  settings.backend = "serial";
  settings.noise = 0.5;
  settings.samples_per_pixel = 40;
  settings.width = 37;
  settings.height = 29;
  const Outcome decided = render_bits(parity_scene("cornell"), settings);
  ASSERT_LT(decided.statistics.noise.mean_samples, 40);

  Diagnostics diagnostics;
  size_t warned = 0;
  RenderEvents events;
  events.started = [](const RenderStatistics&) { refused_size = 37 * 29 * sizeof(float); };
  events.warned = [&] { ++warned; };
  Scene scene = parity_scene("cornell");
  const RenderSettings resolved = resolve_settings(settings, scene);
  const Outcome undecided = outcome_of(render_scene(std::move(scene), resolved, 0, events, diagnostics));
  refused_size = 0;
  ASSERT_EQ(diagnostics.warnings().size(), 1u) << "three estimates fail, one warning is given";
  EXPECT_NE(diagnostics.warnings()[0].message.find("no memory was left to estimate the noise"), std::string::npos);
  EXPECT_EQ(warned, 1u);
  EXPECT_TRUE(undecided.statistics.complete);
  EXPECT_EQ(undecided.statistics.noise.noise, 1);
  EXPECT_EQ(undecided.statistics.noise.below, 0);
  EXPECT_EQ(undecided.statistics.noise.mean_samples, 40);

  settings.noise = 0;
  EXPECT_EQ(render_bits(parity_scene("cornell"), settings).rows, undecided.rows);
}

}  // namespace

}  // namespace alhazen::impl::test
