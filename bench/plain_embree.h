#pragma once

// A compiled scene as one would hand it to Embree without a renderer around it: its own triangles and spheres, no
// filters, the flags that it has by default, the high-quality build. The yardstick that our traversal is measured with.

#include "backends/embree/api.h"
#include "core/scene_view.h"

namespace alhazen {

class PlainEmbree {
 public:
  /// `view` must outlive it. Throws std::runtime_error where Embree refuses.
  PlainEmbree(const SceneView<float>& view, int threads);
  ~PlainEmbree();
  PlainEmbree(const PlainEmbree&) = delete;
  PlainEmbree& operator=(const PlainEmbree&) = delete;

  const EmbreeTracer& tracer() const { return tracer_; }

 private:
  void add_triangles(const SceneView<float>& view);
  template <class Record, class At>
  void add_spheres(const Record* spheres, uint32_t count, unsigned int time_steps, const At& center_at);
  void attach(RTCGeometry geometry);

  RTCDevice device_;
  EmbreeTracer tracer_{};
};

}  // namespace alhazen
