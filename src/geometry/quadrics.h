#pragma once

// Spheres, cylinders and disks, and where meshes must take their place.

#include "scene/scene.h"

namespace alhazen::impl {

bool is_similarity(const MovingTransform& transform);

bool is_cylinder_or_disk(const Shape& shape);

/// Returns whether a cylinder or disk is exact where `world_from_object` places it: it is at rest, and its thickness is
/// not lost in the rounding of coordinates along it.
bool stays_exact(const Shape& shape, const MovingTransform& world_from_object);

/// Of a sphere, cylinder or disk.
Mesh mesh_of_quadric(const Shape& shape);

/// Instances copy cylinders and disks. Where these were more, they become meshes, which instances share.
inline constexpr uint64_t max_quadric_copies = 1u << 17;

/// Whether tessellate_inexact_quadrics would replace any.
bool has_inexact_quadrics(const Scene& scene);

/// Replaces by meshes, one for all equal shapes, spheres that transforms stretch, and cylinders and disks that are not
/// exact or emit light. The shapes keep their order.
void tessellate_inexact_quadrics(Scene& scene);

}  // namespace alhazen::impl
