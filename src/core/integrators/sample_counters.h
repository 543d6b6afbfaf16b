#pragma once

// Counts of what `path` samples and then does not use. Only builds with ALHAZEN_COUNTERS count (docs/cpu.md#counters):
// in all others `counts_samples` is false, records hold no counters, and no branch remains.

#include <cstdint>
#include <type_traits>

#include "core/lights/light_list.h"
#include "core/materials/material_list.h"

namespace ALHAZEN_CORE {

#if defined(ALHAZEN_COUNTERS)
inline constexpr bool counts_samples = true;
#else
inline constexpr bool counts_samples = false;
#endif

#define ALHAZEN_KIND(name, Name) +1
inline constexpr uint32_t light_kinds = 3 ALHAZEN_LIGHTS(ALHAZEN_KIND);
inline constexpr uint32_t material_kinds = 0 ALHAZEN_MATERIALS(ALHAZEN_KIND);
#undef ALHAZEN_KIND

/// Samples of lights. Those that are neither unlit nor black have a shadow ray.
struct LightSampleCounts {
  uint64_t drawn = 0;
  uint64_t unlit = 0;    ///< the light sends nothing to the point
  uint64_t black = 0;    ///< the surface scatters nothing of it
  uint64_t blocked = 0;  ///< the shadow ray is occluded

  ALHAZEN_HD uint64_t shadow_rays() const { return drawn - unlit - black; }
  ALHAZEN_HD void add(const LightSampleCounts& other) {
    drawn += other.drawn;
    unlit += other.unlit;
    black += other.black;
    blocked += other.blocked;
  }
};

/// Samples of directions.
struct BsdfSampleCounts {
  uint64_t drawn = 0;
  uint64_t black = 0;     ///< no direction, one on the wrong side, or of weight 0
  uint64_t roulette = 0;  ///< ended by Russian roulette

  ALHAZEN_HD void add(const BsdfSampleCounts& other) {
    drawn += other.drawn;
    black += other.black;
    roulette += other.roulette;
  }
};

struct SampleCounters {
  LightSampleCounts by_light[light_kinds];       ///< by LightKind
  LightSampleCounts by_closure[material_kinds];  ///< the same samples by the MaterialKind of the surface
  BsdfSampleCounts bsdf[material_kinds];         ///< by MaterialKind
  uint32_t light = 0, closure = 0;               ///< kinds of the last light sample

  ALHAZEN_HD void add(const SampleCounters& other) {
    for (uint32_t i = 0; i < light_kinds; ++i) by_light[i].add(other.by_light[i]);
    for (uint32_t i = 0; i < material_kinds; ++i) by_closure[i].add(other.by_closure[i]);
    for (uint32_t i = 0; i < material_kinds; ++i) bsdf[i].add(other.bsdf[i]);
  }

  ALHAZEN_HD void count_light_sample(LightKind light_kind, MaterialKind closure_kind, bool is_unlit, bool is_black) {
    light = static_cast<uint32_t>(light_kind), closure = static_cast<uint32_t>(closure_kind);
    const LightSampleCounts sample{1, is_unlit ? 1u : 0u, is_black ? 1u : 0u, 0};
    by_light[light].add(sample);
    by_closure[closure].add(sample);
  }

  /// The shadow ray of the last light sample is occluded.
  ALHAZEN_HD void count_blocked() {
    ++by_light[light].blocked;
    ++by_closure[closure].blocked;
  }

  ALHAZEN_HD void count_bsdf_sample(MaterialKind kind, bool is_black, bool is_ended) {
    bsdf[static_cast<uint32_t>(kind)].add({1, is_black ? 1u : 0u, is_ended ? 1u : 0u});
  }
};

struct NoCounters {
  ALHAZEN_HD void add(const NoCounters&) {}
};

/// The counters of a record, which take no space in it where the build does not count.
using RecordCounters = std::conditional_t<counts_samples, SampleCounters, NoCounters>;

/// Whether this build counts what is sampled for such a record.
template <class Record>
inline constexpr bool has_counters = counts_samples&& requires(Record& record) {
  record.counters;
};

}  // namespace ALHAZEN_CORE
