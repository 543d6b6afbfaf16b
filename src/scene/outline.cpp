#include "scene/outline.h"

namespace alhazen::impl {

Scene outline_of(const Scene& scene, bool with_light_maps) {
  Scene outline;
  outline.name = scene.name;
  outline.up = scene.up;
  outline.camera = scene.camera;
  outline.film = scene.film;
  outline.filter = scene.filter;
  outline.sampler = scene.sampler;
  outline.samples_per_pixel = scene.samples_per_pixel;
  outline.quality = scene.quality;
  outline.seed = scene.seed;
  outline.integrator = scene.integrator;
  outline.replaced_integrator = scene.replaced_integrator;
  outline.max_depth = scene.max_depth;
  outline.transform_start_time = scene.transform_start_time;
  outline.transform_end_time = scene.transform_end_time;
  outline.images.resize(scene.images.size());
  outline.textures = scene.textures;
  outline.materials = scene.materials;
  outline.meshes.resize(scene.meshes.size());
  outline.groups = scene.groups;
  outline.instances = scene.instances;
  outline.lights = scene.lights;
  outline.environments.resize(scene.environments.size());
  outline.light_images.resize(scene.light_images.size());
  if (with_light_maps) {
    outline.environments = scene.environments;
    outline.light_images = scene.light_images;
  }
  outline.light_sampling = scene.light_sampling;
  outline.coats = scene.coats;
  return outline;
}

}  // namespace alhazen::impl
