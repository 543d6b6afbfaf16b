#pragma once

// The interface of the module `embree`. The program itself is built without the headers of Embree.

#include <memory>
#include <string>

#include "core/integrators/camera_sample.h"
#include "core/sampling/any_sampler.h"
#include "core/scene_view.h"
#include "render/kernels/request.h"

namespace alhazen::impl {

/// The Embree structures of a compiled scene, which must outlive them.
class EmbreeStructures {
 public:
  virtual ~EmbreeStructures() = default;
  /// Returns the tracer to pass to the kernels that select_kernel returns.
  virtual const ExternalTracer* tracer_for_kernels() const = 0;
};

struct EmbreeModule {
  static constexpr const char* name = "embree";
  static constexpr const char* how_to_get = "install libembree-dev and build the target alhazen_embree";

  std::string (*version)();
  /// Throws InputError if the scene exceeds the range of Embree, and std::runtime_error with the reason if Embree
  /// fails.
  std::unique_ptr<EmbreeStructures> (*build)(const SceneView<float>& view, int threads);
  RawKernel (*select_kernel)(IntegratorKind integrator, SamplerType sampler);
};

}  // namespace alhazen::impl
