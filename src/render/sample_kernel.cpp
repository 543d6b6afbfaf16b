#include "render/sample_kernel.h"

#include "util/diagnostics.h"

namespace alhazen::impl {

ALHAZEN_DECLARE_KERNEL(RawKernel select_float_kernel(uint32_t integrator, uint32_t sampler))
ALHAZEN_DECLARE_KERNEL(RawKernel select_double_kernel(uint32_t integrator, uint32_t sampler))

namespace {

std::vector<InstructionSet> find_built_sets() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512})
    if (ALHAZEN_KERNEL_OF(set, select_float_kernel)) sets.push_back(set);
  return sets;
}

bool processor_has(InstructionSet set) {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (set == InstructionSet::avx2) return __builtin_cpu_supports("x86-64-v3");
  if (set == InstructionSet::avx512) return __builtin_cpu_supports("x86-64-v4");
#endif
  return set == InstructionSet::baseline;
}

std::vector<InstructionSet> find_instruction_sets() {
  std::vector<InstructionSet> sets;
  std::string names;
  for (const InstructionSet set : built_instruction_sets()) {
    if (processor_has(set)) sets.push_back(set);
    names += (names.empty() ? "" : ", ") + to_string(set);
  }
  if (sets.empty())
    throw alhazen::UnsupportedError(
        "this program can take samples with " + names +
        " alone, which this processor lacks: build it here, or with -DALHAZEN_INSTRUCTION_SETS=all");
  return sets;
}

}  // namespace

const std::vector<InstructionSet>& built_instruction_sets() {
  static const std::vector<InstructionSet> sets = find_built_sets();
  return sets;
}

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

}  // namespace alhazen::impl
