#pragma once

// Denoises images with OptiX. The model is the one for several layers (AOV), since its normals are in world space; here
// it has one layer.

#include "backends/optix/module/pipeline.h"
#include "render/denoiser.h"

namespace alhazen::impl::optix {

template <cuda::KernelExecutor Executor>
class Denoiser {
 public:
  Denoiser(const OptixFunctionTable& functions, const Context& context, Executor& executor)
      : functions_(functions),
        context_(context),
        executor_(executor),
        radiance_(executor),
        albedo_(executor),
        normal_(executor),
        output_(executor),
        state_(executor),
        scratch_(executor) {
    OptixDenoiserOptions options{};
    options.guideAlbedo = options.guideNormal = 1;
    check(functions_,
          functions_.optixDenoiserCreate(context.get(), OPTIX_DENOISER_MODEL_KIND_AOV, &options, &denoiser_),
          "starting its denoiser", context.log());
  }
  ~Denoiser() { functions_.optixDenoiserDestroy(denoiser_); }
  Denoiser(const Denoiser&) = delete;
  Denoiser& operator=(const Denoiser&) = delete;

  std::vector<float> denoise(const NoisyImage& image) {
    const unsigned width = static_cast<unsigned>(image.width), height = static_cast<unsigned>(image.height);
    OptixDenoiserSizes sizes{};
    ask(functions_.optixDenoiserComputeMemoryResources(denoiser_, width, height, &sizes));
    state_.reserve(sizes.stateSizeInBytes);
    scratch_.reserve(sizes.withoutOverlapScratchSizeInBytes);
    ask(functions_.optixDenoiserSetup(denoiser_, executor_.stream(), width, height, address(state_.data()),
                                      sizes.stateSizeInBytes, address(scratch_.data()),
                                      sizes.withoutOverlapScratchSizeInBytes));
    OptixDenoiserGuideLayer guides{};
    guides.albedo = upload(albedo_, image.albedo.mean, width, height);
    guides.normal = upload(normal_, image.normal.mean, width, height);
    OptixDenoiserLayer layer{};
    layer.input = upload(radiance_, image.radiance.mean, width, height);
    output_.reserve(image.radiance.mean.size());
    layer.output = image_of(output_, width, height);
    const OptixDenoiserParams params{};  // without a given intensity, OptiX determines the exposure
    ask(functions_.optixDenoiserInvoke(denoiser_, executor_.stream(), &params, address(state_.data()),
                                       sizes.stateSizeInBytes, &guides, &layer, 1, 0, 0, address(scratch_.data()),
                                       sizes.withoutOverlapScratchSizeInBytes));
    std::vector<float> denoised(image.radiance.mean.size());
    executor_.download(denoised.data(), output_.data(), denoised.size() * sizeof(float));
    return denoised;
  }

 private:
  using Floats = cuda::Buffer<Executor, float>;
  using Bytes = cuda::Buffer<Executor, std::byte>;

  void ask(OptixResult result) const { check(functions_, result, "denoising", context_.log()); }

  OptixImage2D upload(Floats& memory, const std::vector<float>& values, unsigned width, unsigned height) {
    memory.reserve(values.size());
    executor_.upload(memory.data(), values.data(), values.size() * sizeof(float));
    return image_of(memory, width, height);
  }

  static OptixImage2D image_of(const Floats& memory, unsigned width, unsigned height) {
    constexpr unsigned pixel = 3 * sizeof(float);
    return {address(memory.data()), width, height, width * pixel, pixel, OPTIX_PIXEL_FORMAT_FLOAT3};
  }

  const OptixFunctionTable& functions_;
  const Context& context_;
  Executor& executor_;
  OptixDenoiser denoiser_ = nullptr;
  Floats radiance_, albedo_, normal_, output_;
  Bytes state_, scratch_;
};

}  // namespace alhazen::impl::optix
