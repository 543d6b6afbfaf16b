#include "backends/openmp/openmp.h"
#include "render/backend.h"

#if defined(ALHAZEN_WITH_EMBREE)
#include <optional>

#include "backends/embree/scene.h"
#endif

namespace alhazen {

#if defined(ALHAZEN_WITH_EMBREE)
namespace baseline {
RawKernel select_embree_kernel(uint32_t integrator, uint32_t sampler);
}
#if defined(__x86_64__) && !defined(ALHAZEN_BASELINE_ONLY)
namespace avx2 {
RawKernel select_embree_kernel(uint32_t integrator, uint32_t sampler);
}
namespace avx512 {
RawKernel select_embree_kernel(uint32_t integrator, uint32_t sampler);
}
#endif
#endif

namespace {

/// The strategies of OpenMP, with Embree as what answers ray queries.
class EmbreeBackend final : public Backend {
 public:
  BackendDescription describe() const override {
    BackendDescription description{"embree", openmp_strategies(), true, "", {}};
    description.traces_double = false;
#if defined(ALHAZEN_WITH_EMBREE)
    description.details = "Embree " + std::string(RTC_VERSION_STRING) + ", " + to_string(instruction_sets().back());
#else
    description.available = false;
    description.details = "this binary was made without it: install libembree-dev and build again";
#endif
    return description;
  }

#if defined(ALHAZEN_WITH_EMBREE)
  BvhLayouts wanted_layouts(const RenderSettings&) const override { return {}; }
  void start(const RenderSettings& settings) override { threads_ = settings.threads; }
  void prepare(const CompiledScene<float>& scene) override { scene_.emplace(scene.view, threads_); }

  void render_pass(const RenderPass<float>& pass) override {
    const auto select = ALHAZEN_KERNEL_OF(instruction_sets().back(), select_embree_kernel);
    const SampleKernel<float> kernel(
        select(static_cast<uint32_t>(pass.settings.integrator), static_cast<uint32_t>(pass.settings.sampler)));
    render_openmp(RenderPass<float>{pass.scene, kernel, pass.settings, pass.film, pass.control, pass.first_sample,
                                    pass.sample_count, &scene_->tracer()});
  }
#else
  void render_pass(const RenderPass<float>&) override {}
#endif
  void render_pass(const RenderPass<double>&) override {}

 private:
#if defined(ALHAZEN_WITH_EMBREE)
  int threads_ = 0;
  std::optional<EmbreeScene> scene_;
#endif
};

}  // namespace

std::unique_ptr<Backend> make_embree_backend() { return std::make_unique<EmbreeBackend>(); }

}  // namespace alhazen
