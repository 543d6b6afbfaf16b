#include "render/sample_kernel.h"

namespace alhazen {

#define ALHAZEN_DECLARE_KERNELS(set)                                     \
  namespace set {                                                        \
  RawKernel select_float_kernel(uint32_t integrator, uint32_t sampler);  \
  RawKernel select_double_kernel(uint32_t integrator, uint32_t sampler); \
  }
ALHAZEN_DECLARE_KERNELS(baseline)
#if defined(__x86_64__) && !defined(ALHAZEN_BASELINE_ONLY)
ALHAZEN_DECLARE_KERNELS(avx2)
ALHAZEN_DECLARE_KERNELS(avx512)
#endif

namespace {

std::vector<InstructionSet> find_instruction_sets() {
  std::vector<InstructionSet> sets{InstructionSet::baseline};
#if defined(__x86_64__) && !defined(ALHAZEN_BASELINE_ONLY)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("x86-64-v3")) sets.push_back(InstructionSet::avx2);
  if (__builtin_cpu_supports("x86-64-v4")) sets.push_back(InstructionSet::avx512);
#endif
  return sets;
}

}  // namespace

const std::vector<InstructionSet>& instruction_sets() {
  static const std::vector<InstructionSet> sets = find_instruction_sets();
  return sets;
}

std::string to_string(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx2:
      return "AVX2";
    case InstructionSet::avx512:
      return "AVX-512";
    case InstructionSet::baseline:
      break;
  }
  return "the processor's baseline instructions";
}

template <>
SampleKernel<float> select_sample_kernel(IntegratorKind integrator, SamplerType sampler, InstructionSet set) {
  const auto select = ALHAZEN_KERNEL_OF(set, select_float_kernel);
  return SampleKernel<float>(select(static_cast<uint32_t>(integrator), static_cast<uint32_t>(sampler)));
}

template <>
SampleKernel<double> select_sample_kernel(IntegratorKind integrator, SamplerType sampler, InstructionSet set) {
  const auto select = ALHAZEN_KERNEL_OF(set, select_double_kernel);
  return SampleKernel<double>(select(static_cast<uint32_t>(integrator), static_cast<uint32_t>(sampler)));
}

}  // namespace alhazen
