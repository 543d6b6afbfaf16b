#pragma once

// Renders a scene from a reader at 4 x 4 pixels with one sample each, to test what happens after reading. Scenes that
// would take seconds are skipped, so that a fuzzer gets to many others.

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "render/renderer.h"

namespace alhazen::impl::fuzzing {

inline constexpr uint64_t max_triangles = 20'000, max_texels = 1u << 20;
inline constexpr size_t max_places = 2000, max_coats = 2;

/// Number of triangles and spheres to be placed, counted per instance.
inline uint64_t count_primitives(const Scene& scene) {
  std::vector<uint64_t> of_group;
  for (const ShapeGroup& group : scene.groups) {
    of_group.push_back(0);
    for (const Shape& shape : group.shapes)
      of_group.back() += shape.type == ShapeType::mesh ? scene.meshes.at(shape.mesh).triangle_count() : 1;
  }
  uint64_t count = of_group.at(0);
  for (const Instance& instance : scene.instances) count += 1 + of_group.at(instance.group);
  return count;
}

inline uint64_t count_texels(const Scene& scene) {
  uint64_t count = 0;
  for (const std::vector<ImageTexels>* images : {&scene.images, &scene.environments, &scene.light_images})
    for (const ImageTexels& image : *images)
      count += static_cast<uint64_t>(image.width) * static_cast<uint64_t>(image.height);
  return count;
}

/// Layered materials have albedo tables computed for them, which takes a tenth of a second and more each.
inline size_t count_coats(const Scene& scene) {
  return static_cast<size_t>(std::count_if(scene.materials.begin(), scene.materials.end(), [](const Material& m) {
    return m.kind == MaterialKind::coated_diffuse || m.kind == MaterialKind::coated_conductor ||
           (m.kind == MaterialKind::principled && (m.principled.ior != 1.5 || m.principled.clearcoat != no_index));
  }));
}

inline bool is_quickly_rendered(const Scene& scene) {
  return count_primitives(scene) <= max_triangles && count_texels(scene) <= max_texels &&
         scene.textures.size() <= max_places && scene.lights.size() <= max_places && count_coats(scene) <= max_coats;
}

/// Every value of the film is a number, but may be infinite, since the values of a scene may be that large.
inline void require_numbers(const Rendering& rendering) {
  const ImageSource source = rendering.source();
  std::vector<float> row(static_cast<size_t>(source.width) * source.channels.size());
  for (int y = 0; y < source.height; ++y) {
    source.fill_row(y, row);
    for (const float value : row)
      if (std::isnan(value)) std::abort();
  }
}

/// `choice` selects the precision. Scenes that cannot be rendered must throw InputError.
inline void render_few_pixels(Scene&& scene, uint8_t choice, Diagnostics& diagnostics) {
  if (!is_quickly_rendered(scene)) return;
  omp_set_num_threads(1);
  scene.film.pixel_bounds.reset();
  Settings asked;
  asked.backend = "serial";
  asked.width = asked.height = 4;
  asked.threads = 1;
  asked.samples_per_pixel = 1;
  asked.precision = choice % 2 == 0 ? "float" : "double";
  asked.integrator = "path";
  asked.max_depth = std::clamp<int64_t>(scene.max_depth, 0, 8);
  asked.aovs = {"alpha", "albedo", "normal",      "depth",   "distance", "position",
                "uv",    "object", "cryptomatte", "bounces", "samples",  "variance"};
  const RenderSettings settings = resolve_settings(asked, scene);
  require_numbers(render_scene(std::move(scene), settings, 0, {}, diagnostics));
}

/// The last byte of an input, which most formats ignore.
inline uint8_t last_of(std::span<const uint8_t> bytes) { return bytes.empty() ? uint8_t{0} : bytes.back(); }

}  // namespace alhazen::impl::fuzzing
