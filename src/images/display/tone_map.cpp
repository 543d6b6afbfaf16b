#include "images/display/tone_map.h"

#include <algorithm>
#include <iterator>

namespace alhazen::impl {

namespace {

struct NamedToneMap {
  const char* name;
  ToneMap kind;
};

constexpr NamedToneMap named_tone_maps[] = {{"none", ToneMap::none},
                                            {"reinhard", ToneMap::reinhard},
                                            {"filmic", ToneMap::filmic},
                                            {"aces", ToneMap::aces},
                                            {"agx", ToneMap::agx}};

/// Clamps to finite non-negative values. The bound keeps the quotients below from becoming infinity over infinity.
double displayable(double value) { return value > 0 ? std::min(value, 1e30) : 0; }

/// Reinhard et al. 2002, "Photographic Tone Reproduction for Digital Images", equation 3: applied to the luminance,
/// which preserves hue and saturation.
Vec3d reinhard(const Vec3d& colour) { return colour / (1 + luminance(colour)); }

/// Narkowicz 2015, "ACES Filmic Tone Mapping Curve": a rational fit to the ACES output transform, per channel.
double filmic(double x) { return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14); }

/// Hill's rational fit to the reference rendering transform and the output transform for sRGB displays, per channel.
double aces_curve(double x) {
  return (x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081);
}

/// Hill 2016, in Pettineo's "BakingLab": the curve above between two matrices, which lead from linear sRGB to the
/// primaries AP1 and back, and which desaturate as the two transforms do. Bright saturated colours turn to white.
Vec3d aces(const Vec3d& colour) {
  const Vec3d in{dot(Vec3d{0.59719, 0.35458, 0.04823}, colour), dot(Vec3d{0.07600, 0.90834, 0.01566}, colour),
                 dot(Vec3d{0.02840, 0.13383, 0.83777}, colour)};
  const Vec3d out{aces_curve(in.x), aces_curve(in.y), aces_curve(in.z)};
  return {dot(Vec3d{1.60475, -0.53108, -0.07367}, out), dot(Vec3d{-0.10208, 1.10813, -0.00605}, out),
          dot(Vec3d{-0.00327, -0.07276, 1.07602}, out)};
}

}  // namespace

Vec3d tone_map(const Vec3d& colour, ToneMap kind) {
  Vec3d mapped{displayable(colour.x), displayable(colour.y), displayable(colour.z)};
  switch (kind) {
    case ToneMap::none:
      break;
    case ToneMap::reinhard:
      mapped = reinhard(mapped);
      break;
    case ToneMap::filmic:
      mapped = {filmic(mapped.x), filmic(mapped.y), filmic(mapped.z)};
      break;
    case ToneMap::aces:
      mapped = aces(mapped);
      break;
    case ToneMap::agx:
      mapped = agx(mapped);
      break;
  }
  return max(min(mapped, splat(1.0)), splat(0.0));
}

ToneMap tone_map_named(const std::string& name) {
  if (name.empty()) return ToneMap::none;
  std::string names;
  for (const NamedToneMap& each : named_tone_maps) {
    if (name == each.name) return each.kind;
    names += (names.empty() ? "" : ", ") + std::string(each.name);
  }
  throw InputError("unknown tone map '" + name + "': it may be " + names);
}

std::string to_string(ToneMap kind) {
  for (const NamedToneMap& each : named_tone_maps)
    if (each.kind == kind) return each.name;
  return {};
}

std::string tone_map_names() {
  constexpr size_t count = std::size(named_tone_maps);
  std::string names;
  for (size_t i = 0; i < count; ++i)
    names += (i == 0 ? "" : i + 1 < count ? ", " : " or ") + std::string(named_tone_maps[i].name);
  return names;
}

}  // namespace alhazen::impl
