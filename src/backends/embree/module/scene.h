#pragma once

// Builds the Embree structures of a compiled scene. Embree reads triangles in place from the arena and intersects other
// primitives with our own test.

#include <vector>

#include "backends/embree/module/api.h"
#include "core/scene_view.h"

namespace alhazen::impl {

/// Owns the Embree structures of `view`, which must outlive them.
class EmbreeScene {
 public:
  /// Throws InputError if the scene exceeds the range of Embree, and std::runtime_error with the reason if Embree
  /// fails.
  EmbreeScene(const SceneView<float>& view, int threads);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  const EmbreeTracer& tracer() const { return tracer_; }
  /// Returns the memory that Embree has allocated for the scene, in bytes.
  int64_t bytes() const { return bytes_; }

 private:
  /// Returns an empty scene, for the world or for an object.
  RTCScene new_scene();
  void add_triangles(RTCScene to, uint32_t first, uint32_t count);
  void add_instances();
  /// Adds the `count` primitives of a kind that Embree does not know; triangles it knows.
  template <PrimitiveKind kind>
  void add_user_geometry(uint32_t count);
  void attach(RTCScene to, RTCGeometry geometry, PrimitiveKind kind);
  void check() const;

  const SceneView<float>& view_;
  std::vector<RTCScene> objects_;
  int64_t bytes_ = 0;
  RTCDevice device_ = nullptr;
  EmbreeTracer tracer_{};
};

}  // namespace alhazen::impl
