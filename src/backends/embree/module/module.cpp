#include "backends/embree/module.h"

#include "backends/embree/module/scene.h"
#include "render/sample_kernel.h"
#include "util/define_module.h"

namespace alhazen::impl {

ALHAZEN_DECLARE_KERNEL(RawKernel select_embree_kernel(uint32_t integrator, uint32_t sampler))

namespace {

class Structures final : public EmbreeStructures {
 public:
  Structures(const SceneView<float>& view, int threads) : scene_(view, threads) {}
  const ExternalTracer* tracer_for_kernels() const override { return &scene_.tracer(); }

 private:
  EmbreeScene scene_;
};

std::string version() { return RTC_VERSION_STRING; }

std::unique_ptr<EmbreeStructures> build(const SceneView<float>& view, int threads) {
  return std::make_unique<Structures>(view, threads);
}

RawKernel select_kernel(IntegratorKind integrator, SamplerType sampler) {
  const auto select = ALHAZEN_KERNEL_OF(instruction_sets().back(), select_embree_kernel);
  return select(static_cast<uint32_t>(integrator), static_cast<uint32_t>(sampler));
}

const EmbreeModule table{version, build, select_kernel};

}  // namespace

}  // namespace alhazen::impl

ALHAZEN_MODULE("embree", alhazen::impl::table)
