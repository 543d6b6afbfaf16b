// The backend `embree` runs the OpenMP strategies and traces rays with Embree.

#include "backends/embree/module.h"
#include "backends/openmp/openmp.h"
#include "render/backend.h"
#include "util/module.h"

namespace alhazen::impl {

namespace {

class EmbreeBackend final : public Backend {
 public:
  BackendTraits traits() const override {
    BackendTraits traits{"embree", openmp_strategies(), "the CPU's cores, rays traced by Embree, in float"};
    traits.traces_double = false;
    return traits;
  }

  BackendStatus status() const override {
    const Module& module = load_module<EmbreeModule>();
    if (!module.functions) return {false, module.problem};
    return {true, "Embree " + functions().version() + ", " + to_string(instruction_sets().back()), {}, module.path};
  }

  BvhLayouts wanted_layouts(const RenderSettings&) const override { return {}; }
  void start(const RenderSettings& settings) override { threads_ = settings.threads; }
  void prepare(const CompiledScene<float>& scene) override { structures_ = functions().build(scene.view, threads_); }

  void render_pass(const RenderPass<float>& pass) override {
    const SampleKernel<float> kernel(functions().select_kernel(pass.integrator, pass.settings.sampler));
    render_openmp(RenderPass<float>{pass.scene, kernel, pass.settings, pass.film, pass.control, pass.first_sample,
                                    pass.sample_count, pass.integrator, pass.guiding,
                                    structures_->tracer_for_kernels()});
  }
  void render_pass(const RenderPass<double>&) override {}

 private:
  static const EmbreeModule& functions() { return functions_of<EmbreeModule>(load_module<EmbreeModule>()); }

  int threads_ = 0;
  std::unique_ptr<EmbreeStructures> structures_;
};

}  // namespace

std::unique_ptr<Backend> make_embree_backend() { return std::make_unique<EmbreeBackend>(); }

}  // namespace alhazen::impl
