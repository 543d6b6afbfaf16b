#pragma once

// What a scene contains, for people: names and sizes of what a file describes, before it is compiled.

#include <cstdint>
#include <string>
#include <vector>

#include "core/math/bounds.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// A mesh, another shape, or a group of shapes that instances place.
struct ObjectDescription {
  std::string name;         ///< in the file, else its place there
  uint64_t triangles = 0;   ///< of one instance
  uint64_t primitives = 0;  ///< spheres, cylinders and disks of one instance
  uint64_t instances = 1;
  uint64_t bytes = 0;    ///< of its meshes as they are described
  std::string material;  ///< of its shapes; with several "3 materials"
};

struct MaterialDescription {
  std::string name;
  std::string kind;
  uint64_t shapes = 0;  ///< that have it
};

struct LightDescription {
  std::string name;  ///< by which a light group names it; of emissive shapes in groups, that of the group
  std::string kind;
  SourceLocation where;
  Vec3d radiance;          ///< of emissive shapes and infinite lights; else intensity or irradiance (scene/scene.h)
  uint64_t triangles = 0;  ///< emissive shapes
};

struct ImageDescription {
  std::string name, use;  ///< use: texture, environment map, image of a light
  int width = 0, height = 0, channels = 0, bits = 0;
  uint64_t bytes = 0;  ///< in memory, without the smaller levels that filtering needs
};

struct SceneDescription {
  Bounds3<double> bounds;  ///< of all shapes where motion starts; empty if there are none
  uint64_t triangles = 0;  ///< with every instance counted
  uint64_t stored_triangles = 0, primitives = 0, instances = 0;
  std::vector<ObjectDescription> objects;      ///< largest first
  std::vector<MaterialDescription> materials;  ///< most used first
  std::vector<LightDescription> lights;        ///< in the order of the file
  std::vector<ImageDescription> images;        ///< largest first
  uint64_t textures = 0;                       ///< nodes, also those that are no images
  uint64_t image_bytes = 0, mesh_bytes = 0;
};

SceneDescription describe(const Scene& scene);

}  // namespace alhazen::impl
