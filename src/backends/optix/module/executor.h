#pragma once

// An executor (backends/cuda/executor.h) that runs pixel kernels as OptiX launches. `Base` implements everything else
// and provides stream().

#include <optional>
#include <utility>

#include "backends/optix/module/pipeline.h"

namespace alhazen::impl::optix {

template <cuda::KernelExecutor Base>
class OptixExecutor : public Base {
 public:
  template <class... Arguments>
  OptixExecutor(const OptixFunctionTable& functions, const DeviceCode& code, Arguments&&... arguments)
      : Base(std::forward<Arguments>(arguments)...),
        functions_(functions),
        code_(code),
        context_(functions),
        acceleration_(functions, *this),
        records_(*this),
        params_(*this) {}

  /// Compiles the programs and builds the acceleration structures for a scene. `device` is the view of its copy on the
  /// device.
  void build(const SceneView<float>& host, const SceneView<float>& device) {
    const typename Base::Range range("build for OptiX");
    pipeline_.emplace(functions_, context_, code_, SceneTraits(host));
    acceleration_.build(context_.get(), host, device);
    const std::vector<SbtRecord> records = pipeline_->records();
    records_.reserve(records.size());
    this->upload(records_.data(), records.data(), records.size() * sizeof(SbtRecord));
    params_.reserve(1);
  }

  /// Launches one thread per pixel. OptiX chooses the block size.
  template <IntegratorKind kind>
  void launch(const OptixKernel<kind>& kernel, cuda::Extent threads, cuda::Extent) {
    const OptixParams params{kernel.launch, kernel.sums, acceleration_.traversable(), acceleration_.sbt_offset()};
    this->upload(params_.data(), &params, sizeof(params));
    const OptixShaderBindingTable table = binding_table(raygen_of(kind));
    check(functions_,
          functions_.optixLaunch(pipeline_->get(), this->stream(), address(params_.data()), sizeof(params), &table,
                                 threads.width, threads.height, 1),
          "rendering", context_.log());
  }

 private:
  OptixShaderBindingTable binding_table(RaygenRecord raygen) const {
    OptixShaderBindingTable table{};
    table.raygenRecord = address(records_.data() + raygen);
    table.missRecordBase = address(records_.data() + raygen_records);
    table.missRecordStrideInBytes = sizeof(SbtRecord);
    table.missRecordCount = miss_records;
    table.hitgroupRecordBase = address(records_.data() + raygen_records + miss_records);
    table.hitgroupRecordStrideInBytes = sizeof(SbtRecord);
    table.hitgroupRecordCount = hit_records;
    return table;
  }

  const OptixFunctionTable& functions_;
  DeviceCode code_;
  Context context_;
  Acceleration<Base> acceleration_;
  std::optional<Pipeline> pipeline_;
  cuda::Buffer<Base, SbtRecord> records_;
  cuda::Buffer<Base, OptixParams> params_;
};

}  // namespace alhazen::impl::optix
