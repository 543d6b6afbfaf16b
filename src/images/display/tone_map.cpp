#include "images/display/tone_map.h"

#include <algorithm>

namespace alhazen {

namespace {

/// Clamps to finite non-negative values. The bound keeps the quotients below from becoming infinity over infinity.
double displayable(double value) { return value > 0 ? std::min(value, 1e30) : 0; }

/// Reinhard et al. 2002, "Photographic Tone Reproduction for Digital Images", equation 3: applied to the luminance,
/// which preserves hue and saturation.
Vec3d reinhard(const Vec3d& colour) { return colour / (1 + luminance(colour)); }

/// Narkowicz 2015, "ACES Filmic Tone Mapping Curve": a rational fit to the ACES output transform, per channel.
double filmic(double x) { return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14); }

}  // namespace

Vec3d tone_map(const Vec3d& colour, ToneMap kind) {
  Vec3d mapped{displayable(colour.x), displayable(colour.y), displayable(colour.z)};
  if (kind == ToneMap::reinhard) mapped = reinhard(mapped);
  if (kind == ToneMap::filmic) mapped = {filmic(mapped.x), filmic(mapped.y), filmic(mapped.z)};
  return min(mapped, splat(1.0));
}

}  // namespace alhazen
