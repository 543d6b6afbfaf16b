#pragma once

// What the module `embree` hands out. The program itself is built without Embree's headers.

#include <memory>
#include <string>

#include "core/integrators/camera_sample.h"
#include "core/sampling/any_sampler.h"
#include "core/scene_view.h"
#include "render/kernels/request.h"

namespace alhazen {

/// Embree's structures over a compiled scene, which must outlive them.
class EmbreeStructures {
 public:
  virtual ~EmbreeStructures() = default;
  /// What the kernels below trace rays by.
  virtual const ExternalTracer* tracer_for_kernels() const = 0;
};

struct EmbreeModule {
  static constexpr const char* name = "embree";
  static constexpr const char* how_to_get = "install libembree-dev and build the target alhazen_embree";

  std::string (*version)();
  /// Throws std::runtime_error with Embree's reason where they cannot be built.
  std::unique_ptr<EmbreeStructures> (*build)(const SceneView<float>& view, int threads);
  RawKernel (*select_kernel)(IntegratorKind integrator, SamplerType sampler);
};

}  // namespace alhazen
