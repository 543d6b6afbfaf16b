#pragma once

// Evaluates the textures of a material at one point of a surface.

#include "core/materials/lobes/albedo_grid.h"
#include "core/materials/lobes/microfacet.h"
#include "core/textures/texture.h"

namespace ALHAZEN_CORE {

template <class Real>
struct TextureEvaluator {
  const SceneView<Real>& scene;
  const TexturePoint<Real>& at;

  ALHAZEN_HD ALHAZEN_HOT Vec3<Real> value(TextureRange range) const { return evaluate_texture(scene, range, at); }

  /// Clamps each component to [0, 1].
  ALHAZEN_HD ALHAZEN_HOT Vec3<Real> colour(TextureRange range) const {
    return max(min(value(range), splat(Real(1))), Vec3<Real>{});
  }
  ALHAZEN_HD Vec3<Real> colour_or(TextureRange range, Real fallback) const {
    return range.count == 0 ? splat(fallback) : colour(range);
  }
  ALHAZEN_HD ALHAZEN_HOT Real scalar_or(TextureRange range, Real fallback) const {
    return range.count == 0 ? fallback : clamp(value(range).x, Real(0), Real(1));
  }

  /// Returns the alpha of a roughness texture, 0 if it is absent.
  ALHAZEN_HD ALHAZEN_HOT Real alpha(TextureRange range, uint32_t remap) const {
    return alpha_of_roughness(scalar_or(range, Real(0)), remap);
  }
  /// Returns the alphas of a layer, which is never perfectly smooth. If `v` is absent, both are those of `u`.
  ALHAZEN_HD Vec2<Real> layered_alphas(TextureRange u, TextureRange v, uint32_t remap) const {
    const Real along_u = alpha(u, remap);
    return {layered_alpha(along_u), layered_alpha(v.count > 0 ? alpha(v, remap) : along_u)};
  }

  /// Returns the table at an offset in SceneView::albedo_tables.
  ALHAZEN_HD const Real* table(uint32_t first) const { return scene.albedo_tables + first; }
  ALHAZEN_HD AlbedoGridPlace<Real> grid(const AlbedoGridRecord& record, const Vec2<Real>& alpha) const {
    return grid_place(scene.albedo_tables, record, alpha);
  }
};

}  // namespace ALHAZEN_CORE
