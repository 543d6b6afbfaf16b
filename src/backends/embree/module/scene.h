#pragma once

// A compiled scene as Embree takes it: triangles read from the arena where they lie, spheres by our own test.

#include <vector>

#include "backends/embree/module/api.h"
#include "core/scene_view.h"

namespace alhazen {

/// Owns Embree's structures over `view`, which must outlive it.
class EmbreeScene {
 public:
  /// Throws std::runtime_error with Embree's reason where it cannot be built.
  EmbreeScene(const SceneView<float>& view, int threads);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  const EmbreeTracer& tracer() const { return tracer_; }
  /// Memory that Embree holds for it, bytes.
  int64_t bytes() const { return bytes_; }

 private:
  /// One for the world and one for each object.
  RTCScene new_scene();
  void add_triangles(RTCScene to, uint32_t first, uint32_t count);
  void add_instances();
  void add_spheres(PrimitiveKind kind, uint32_t count, RTCBoundsFunction bounds, RTCIntersectFunctionN intersect,
                   RTCOccludedFunctionN occluded, unsigned int time_steps);
  void attach(RTCScene to, RTCGeometry geometry, PrimitiveKind kind);
  void check() const;

  const SceneView<float>& view_;
  std::vector<RTCScene> objects_;
  int64_t bytes_ = 0;
  RTCDevice device_ = nullptr;
  EmbreeTracer tracer_{};
};

}  // namespace alhazen
