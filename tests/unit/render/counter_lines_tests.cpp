// Counters of samples that are not used: sums, tables, and records without them.

#include "render/counter_lines.h"

#include <gtest/gtest.h>

#include <type_traits>

#include "core/film/block_sum.h"

namespace alhazen::impl::test {
namespace {

// Only a build with ALHAZEN_COUNTERS has counters in its records.
static_assert(counts_samples == has_counters<SampleRecord<float>>);
static_assert(!has_counters<PathRecord<float>>);
static_assert(counts_samples || std::is_empty_v<RecordCounters>);

SampleCounters some_counters() {
  SampleCounters counters;
  counters.count_light_sample(LightKind::environment, MaterialKind::diffuse, true, false);
  counters.count_light_sample(LightKind::triangle, MaterialKind::diffuse, false, true);
  counters.count_light_sample(LightKind::triangle, MaterialKind::diffuse, false, false);
  counters.count_light_sample(LightKind::triangle, MaterialKind::principled, false, false);
  counters.count_blocked();
  counters.count_bsdf_sample(MaterialKind::principled, true, false);
  counters.count_bsdf_sample(MaterialKind::principled, false, true);
  counters.count_bsdf_sample(MaterialKind::principled, false, false);
  return counters;
}

TEST(CounterLines, AreOfKindsThatWereDrawn) {
  const CounterLines lines = counter_lines(some_counters());
  ASSERT_EQ(lines.by_light.size(), 2u);
  EXPECT_EQ(lines.by_light[0].kind, "triangle");
  EXPECT_EQ(lines.by_light[0].counts.drawn, 3u);
  EXPECT_EQ(lines.by_light[0].counts.black, 1u);
  EXPECT_EQ(lines.by_light[0].counts.shadow_rays(), 2u);
  EXPECT_EQ(lines.by_light[0].counts.blocked, 1u);
  EXPECT_EQ(lines.by_light[1].kind, "environment");
  EXPECT_EQ(lines.by_light[1].counts.unlit, 1u);
  EXPECT_EQ(lines.by_light[1].counts.shadow_rays(), 0u);
  ASSERT_EQ(lines.by_closure.size(), 2u);
  EXPECT_EQ(lines.by_closure[0].kind, "diffuse");
  EXPECT_EQ(lines.by_closure[0].counts.blocked, 0u);
  EXPECT_EQ(lines.by_closure[1].kind, "principled");
  EXPECT_EQ(lines.by_closure[1].counts.blocked, 1u);
  ASSERT_EQ(lines.bsdf.size(), 1u);
  EXPECT_EQ(lines.bsdf[0].counts.drawn, 3u);
  EXPECT_EQ(lines.bsdf[0].counts.black, 1u);
  EXPECT_EQ(lines.bsdf[0].counts.roulette, 1u);
}

TEST(CounterLines, CountersAddUp) {
  SampleCounters sum = some_counters();
  sum.add(some_counters());
  const CounterLines lines = counter_lines(sum);
  EXPECT_EQ(lines.by_light[0].counts.drawn, 6u);
  EXPECT_EQ(lines.by_light[0].counts.blocked, 2u);
  EXPECT_EQ(lines.bsdf[0].counts.roulette, 2u);
}

TEST(CounterLines, TheTableGivesPercentages) {
  const std::string table = counter_table(some_counters());
  EXPECT_NE(table.find("33.33%"), std::string::npos) << table;  // black samples of triangles
  EXPECT_NE(table.find("50.00%"), std::string::npos) << table;  // blocked shadow rays towards them
  EXPECT_EQ(table.find("sphere"), std::string::npos) << table;
  EXPECT_EQ(counter_table({}).find('%'), std::string::npos);
}

}  // namespace
}  // namespace alhazen::impl::test
