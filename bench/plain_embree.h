#pragma once

// A compiled scene in plain Embree, as an application without a renderer would use it: Embree's own triangles and
// spheres, no filters, default flags, the high-quality build. It is the reference for our traversal.

#include "backends/embree/module/api.h"
#include "core/scene_view.h"

namespace alhazen::impl {

class PlainEmbree {
 public:
  /// `view` must outlive it. Throws std::runtime_error if Embree fails.
  PlainEmbree(const SceneView<float>& view, int threads);
  ~PlainEmbree();
  PlainEmbree(const PlainEmbree&) = delete;
  PlainEmbree& operator=(const PlainEmbree&) = delete;

  const EmbreeTracer& tracer() const { return tracer_; }

 private:
  void add_triangles(const SceneView<float>& view);
  template <class Record, class At>
  void add_spheres(const Record* spheres, uint32_t count, unsigned int time_steps, const At& centre_at);
  void attach(RTCGeometry geometry);

  RTCDevice device_;
  EmbreeTracer tracer_{};
};

}  // namespace alhazen::impl
