#pragma once

// The compiled code by which every backend of the CPU takes samples: once an instruction set, the best of which is
// chosen when the program runs. All of them give the same bits.

#include <cstdint>
#include <string>
#include <vector>

#include "core/film/block_sum.h"
#include "core/integrators/camera_sample.h"
#include "core/sampling/any_sampler.h"
#include "core/scene_view.h"
#include "render/kernels/request.h"

namespace alhazen {

enum class InstructionSet : uint32_t { baseline, avx2, avx512 };

/// Those that this processor has and this binary was made with, the best last.
const std::vector<InstructionSet>& instruction_sets();
std::string to_string(InstructionSet set);

/// The function called `name` of the namespace of an instruction set, for dispatch.
#if defined(__x86_64__) && !defined(ALHAZEN_BASELINE_ONLY)
#define ALHAZEN_KERNEL_OF(set, name) \
  ((set) == InstructionSet::avx512 ? avx512::name : (set) == InstructionSet::avx2 ? avx2::name : baseline::name)
#else
#define ALHAZEN_KERNEL_OF(set, name) ((void)(set), baseline::name)
#endif

/// Takes blocks of samples. A kernel was compiled in a namespace of its instruction set, whose types are these with
/// another name: it is handed their addresses.
template <class Real>
class SampleKernel {
 public:
  explicit SampleKernel(RawKernel raw) : raw_(raw) {}

  /// Takes `count` blocks into `sums`. `tracer` is what the kernel's intersector wants besides the scene.
  void operator()(const SceneView<Real>& scene, const void* tracer, uint32_t seed, uint32_t max_segments,
                  const BlockRequest* blocks, uint32_t count, BlockSum<Real>* sums, bool wants_first_hit = true) const {
    raw_({&scene, tracer, sums, blocks, count, seed, max_segments, wants_first_hit});
  }

 private:
  RawKernel raw_;
};

/// The kernel over the BVH of CPUs.
template <class Real>
SampleKernel<Real> select_sample_kernel(IntegratorKind integrator, SamplerType sampler,
                                        InstructionSet set = instruction_sets().back());

template <>
SampleKernel<float> select_sample_kernel(IntegratorKind integrator, SamplerType sampler, InstructionSet set);
template <>
SampleKernel<double> select_sample_kernel(IntegratorKind integrator, SamplerType sampler, InstructionSet set);

}  // namespace alhazen
