#pragma once

// How far points of surfaces move while the shutter is open, for motion vectors.

#include "core/shapes/instance.h"
#include "core/shapes/surface_interaction.h"

namespace ALHAZEN_CORE {

template <class Real>
ALHAZEN_HD bool scene_moves(const SceneView<Real>& scene) {
  return scene.moving_spheres_count > 0 || scene.instance_motions_count > 0;
}

/// Returns the displacement from shutter open to shutter close, in world space, of the point of a surface that was hit.
template <class Real>
ALHAZEN_HD Vec3<Real> displacement_over_shutter(const SceneView<Real>& scene, const SurfaceInteraction<Real>& si) {
  if (!scene_moves(scene)) return {};
  if (si.primitive.kind() == PrimitiveKind::moving_sphere) return scene.moving_spheres[si.primitive.index()].motion;
  if (si.instance == no_instance || scene.instances[si.instance].motion == no_motion) return {};
  const InstanceRecord<Real> instance = instance_at(scene, si.instance, si.time);
  return transform_point(scene.instance_motions[instance.motion].change,
                         transform_point(instance.object_from_world, si.position));
}

}  // namespace ALHAZEN_CORE
