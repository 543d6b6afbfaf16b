#pragma once

// The compiled code by which every CPU backend takes samples. It exists once per instruction set; the best is chosen at
// run time. All of them give the same bits.

#include <cstdint>
#include <string>
#include <vector>

#include "core/film/block_sum.h"
#include "core/integrators/camera_sample.h"
#include "core/sampling/any_sampler.h"
#include "core/scene_view.h"
#include "render/kernels/request.h"

namespace alhazen::impl {

enum class InstructionSet : uint32_t { baseline, avx2, avx512 };

/// The instruction sets that this binary has kernels for, the best last.
const std::vector<InstructionSet>& built_instruction_sets();
/// Those that the processor supports as well. Throws RenderError if there are none.
const std::vector<InstructionSet>& instruction_sets();
std::string to_string(InstructionSet set);

/// Declares a function in the namespace of every instruction set. The symbols are weak: the address of a function is
/// null where the build leaves its set out (ALHAZEN_INSTRUCTION_SETS of CMake), and no file is compiled again when the
/// build gets another set.
#define ALHAZEN_DECLARE_KERNEL(declaration) \
  namespace baseline {                      \
  [[gnu::weak]] declaration;                \
  }                                         \
  namespace avx2 {                          \
  [[gnu::weak]] declaration;                \
  }                                         \
  namespace avx512 {                        \
  [[gnu::weak]] declaration;                \
  }

/// The function `name` in the namespace of an instruction set, for dispatch.
#define ALHAZEN_KERNEL_OF(set, name) \
  ((set) == InstructionSet::avx512 ? avx512::name : (set) == InstructionSet::avx2 ? avx2::name : baseline::name)

/// Takes blocks of samples. A kernel is compiled in the namespace of its instruction set, where these types have other
/// names, so it takes their addresses.
template <class Real>
class SampleKernel {
 public:
  explicit SampleKernel(RawKernel raw) : raw_(raw) {}

  /// Takes `count` blocks into `sums`. `tracer` holds further arguments of the kernel's intersector.
  void operator()(const SceneView<Real>& scene, const ExternalTracer* tracer, SampleSeed seed, uint32_t max_segments,
                  const BlockRequest* blocks, uint32_t count, BlockSum<Real>* sums, const WantedRecords& wanted = {},
                  PartedLight<Real>* parts = nullptr) const {
    raw_({&scene, tracer, sums, parts, blocks, count, seed.seed, seed.screen_order, max_segments, wanted.first_hit,
          wanted.first_point});
  }

 private:
  RawKernel raw_;
};

/// The kernel over the CPU's BVH.
template <class Real>
SampleKernel<Real> select_sample_kernel(IntegratorKind integrator, SamplerType sampler,
                                        InstructionSet set = instruction_sets().back());

template <>
SampleKernel<float> select_sample_kernel(IntegratorKind integrator, SamplerType sampler, InstructionSet set);
template <>
SampleKernel<double> select_sample_kernel(IntegratorKind integrator, SamplerType sampler, InstructionSet set);

}  // namespace alhazen::impl
