#pragma once

// MTL files: the materials of OBJ files, with the extension for physically based rendering.

#include <optional>
#include <string>
#include <vector>

#include "core/math/vec.h"
#include "files/byte_source.h"
#include "util/diagnostics.h"

namespace alhazen::impl::obj {

/// The image of a parameter, and the options in front of its name.
struct Map {
  std::string file;  ///< empty: none
  Vec2d scale{1, 1}, offset{0, 0};
  bool is_clamped = false;
  double base = 0, gain = 1;   ///< value = base + gain * texel
  double bump_multiplier = 1;  ///< of bump
  SourceLocation where;
};

/// What the file says; absent where it does not.
struct MtlMaterial {
  std::string name;
  SourceLocation where;
  std::optional<Vec3d> diffuse, specular, emission, transmission_filter;  ///< Kd, Ks, Ke, Tf
  std::optional<double> exponent, ior, opacity;                           ///< Ns, Ni, d (or else 1 - Tr)
  std::optional<double> roughness, metallic, sheen;                       ///< Pr, Pm, Ps
  std::optional<double> clearcoat, clearcoat_roughness;                   ///< Pc, Pcr
  std::optional<double> anisotropy, anisotropy_rotation;                  ///< aniso, anisor
  int illumination = 2;                                                   ///< illum
  Map diffuse_map, specular_map, emission_map, opacity_map;               ///< map_Kd, map_Ks, map_Ke, map_d
  Map roughness_map, metallic_map, bump_map, normal_map;                  ///< map_Pr, map_Pm, bump, norm
};

/// Throws InputError with line and column. Statements without effect here give one warning for each kind.
std::vector<MtlMaterial> parse_mtl(ByteSource& source, const std::string& name, Diagnostics& diagnostics);
std::vector<MtlMaterial> read_mtl(const InputPath& path, Diagnostics& diagnostics);

}  // namespace alhazen::impl::obj
