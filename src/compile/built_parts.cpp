#include "compile/built_parts.h"

namespace alhazen::impl {

template <class Real>
PlacedSizes placed_sizes(const SceneArrays<Real>& arrays, size_t described_lights) {
  PlacedSizes sizes;
  const auto count = [](const auto& array) { return static_cast<uint32_t>(array.size()); };
#define ALHAZEN_SIZE(X, kind, Record, records, Block, blocks) sizes.records = count(arrays.records);
  ALHAZEN_PRIMITIVES(ALHAZEN_SIZE, )
#undef ALHAZEN_SIZE
  sizes.positions = count(arrays.positions);
  sizes.normals = count(arrays.normals);
  sizes.uvs = count(arrays.uvs);
  sizes.vertex_attributes = count(arrays.vertex_attributes);
  sizes.vertex_colours = count(arrays.vertex_colours);
  sizes.vertex_tangents = count(arrays.vertex_tangents);
  sizes.sphere_frames = count(arrays.sphere_frames);
  sizes.surfaces = count(arrays.surfaces);
  sizes.lights = static_cast<uint32_t>(arrays.lights.size() - described_lights);
  return sizes;
}

PlacedSizes difference(const PlacedSizes& end, const PlacedSizes& start) {
  PlacedSizes sizes;
#define ALHAZEN_SIZE(X, kind, Record, records, Block, blocks) sizes.records = end.records - start.records;
  ALHAZEN_PRIMITIVES(ALHAZEN_SIZE, )
#undef ALHAZEN_SIZE
  sizes.positions = end.positions - start.positions;
  sizes.normals = end.normals - start.normals;
  sizes.uvs = end.uvs - start.uvs;
  sizes.vertex_attributes = end.vertex_attributes - start.vertex_attributes;
  sizes.vertex_colours = end.vertex_colours - start.vertex_colours;
  sizes.vertex_tangents = end.vertex_tangents - start.vertex_tangents;
  sizes.sphere_frames = end.sphere_frames - start.sphere_frames;
  sizes.surfaces = end.surfaces - start.surfaces;
  sizes.lights = end.lights - start.lights;
  return sizes;
}

template PlacedSizes placed_sizes(const SceneArrays<float>&, size_t);
template PlacedSizes placed_sizes(const SceneArrays<double>&, size_t);

}  // namespace alhazen::impl
