#pragma once

// Shapes, and instances of groups of them.

#include <optional>
#include <string>
#include <variant>

#include "alhazen/geometry.h"
#include "alhazen/handles.h"
#include "alhazen/version.h"

namespace ALHAZEN_NAMESPACE {

/// Centred at the origin of object space.
struct Sphere {
  double radius = 1;  ///< over 0
};

/// About the z axis of object space, open at its ends.
struct Cylinder {
  double radius = 1, z_min = -1, z_max = 1;  ///< over 0; z_min is under z_max
  double phi_max = 360;                      ///< degrees of azimuth from x, over 0 and at most 360
};

/// About the z axis of object space, with its normal along z.
struct Disk {
  double radius = 1, inner_radius = 0, height = 0;  ///< 0 <= inner_radius < radius; it is at z = height
  double phi_max = 360;                             ///< as of Cylinder
};

/// Makes a shape a light.
struct Emission {
  Colour radiance{1};  ///< W / (m^2 sr), not negative
  bool two_sided = false;
  TextureId texture{};  ///< factor on the radiance; none: 1
};

/// What is drawn: a mesh or a quadric, where it is, and of what. `Shape floor{mesh, material};`
struct Shape {
  std::variant<Sphere, Cylinder, Disk, MeshId> geometry{};
  MaterialId material{};        ///< none: a diffuse grey
  MovingTransform transform{};  ///< from object space to world space, or to the space of its group
  std::optional<Emission> emission{};
  /// Flips normals and so also the emitting side. Without it the normal of a mesh is on the side from which triangles
  /// are counter-clockwise in object space, that of a sphere or a cylinder points outward, and that of a disk along z.
  bool reverse_orientation = false;
  std::string name{};  ///< shapes of one name are one object in layers; empty: it is named by its kind and a number
};

/// A group of shapes, placed once more.
struct Instance {
  GroupId group{};
  MovingTransform transform{};  ///< from the group's space to world space
  bool reverse_orientation = false;
  std::string name{};  ///< empty: that of its group, with a number
};

}  // namespace ALHAZEN_NAMESPACE
