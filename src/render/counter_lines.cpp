#include "render/counter_lines.h"

#include <fmt/format.h>

namespace alhazen::impl {

namespace {

#define ALHAZEN_KIND(name, Name) #name,
constexpr const char* light_names[] = {"triangle", "sphere", "moving_sphere", ALHAZEN_LIGHTS(ALHAZEN_KIND)};
constexpr const char* material_names[] = {ALHAZEN_MATERIALS(ALHAZEN_KIND)};
#undef ALHAZEN_KIND

template <class Line, class Counts, size_t size>
std::vector<Line> drawn_lines(const Counts (&counts)[size], const char* const (&names)[size]) {
  std::vector<Line> lines;
  for (size_t i = 0; i < size; ++i)
    if (counts[i].drawn > 0) lines.push_back({names[i], counts[i]});
  return lines;
}

double percentage(uint64_t part, uint64_t whole) {
  return whole > 0 ? 100 * static_cast<double>(part) / static_cast<double>(whole) : 0;
}

std::string light_table(const char* title, const std::vector<LightSampleLine>& lines) {
  std::string text = fmt::format("{:<28} {:>14} {:>8} {:>8} {:>14} {:>9}\n", title, "drawn", "unlit", "black",
                                 "shadow rays", "blocked");
  for (const auto& [kind, counts] : lines)
    text += fmt::format("  {:<26} {:>14} {:>7.2f}% {:>7.2f}% {:>14} {:>8.2f}%\n", kind, counts.drawn,
                        percentage(counts.unlit, counts.drawn), percentage(counts.black, counts.drawn),
                        counts.shadow_rays(), percentage(counts.blocked, counts.shadow_rays()));
  return text;
}

}  // namespace

CounterLines counter_lines(const SampleCounters& counters) {
  return {drawn_lines<LightSampleLine>(counters.by_light, light_names),
          drawn_lines<LightSampleLine>(counters.by_closure, material_names),
          drawn_lines<BsdfSampleLine>(counters.bsdf, material_names)};
}

std::string counter_table(const SampleCounters& counters) {
  const CounterLines lines = counter_lines(counters);
  std::string text =
      light_table("light samples by light", lines.by_light) + light_table("by closure", lines.by_closure);
  text += fmt::format("{:<28} {:>14} {:>8} {:>8}\n", "BSDF samples", "drawn", "black", "roulette");
  for (const auto& [kind, counts] : lines.bsdf)
    text += fmt::format("  {:<26} {:>14} {:>7.2f}% {:>7.2f}%\n", kind, counts.drawn,
                        percentage(counts.black, counts.drawn), percentage(counts.roulette, counts.drawn));
  return text;
}

}  // namespace alhazen::impl
