#include "study/query_kernels.h"

#include "render/sample_kernel.h"
#include "study/kernels/queries.h"

namespace alhazen::impl {

ALHAZEN_DECLARE_KERNEL(RawKernel select_study_kernel(StudyKernel kernel, bool in_double))

namespace study {

KernelChoice kernel_of(Queries queries, Precision precision) {
  const auto select = ALHAZEN_KERNEL_OF(instruction_sets().back(), select_study_kernel);
  const bool in_double = precision == Precision::double_;
  switch (queries) {
    case Queries::linear_scan:
      return {select(StudyKernel::linear_scan, in_double), {}};
    case Queries::binary_bvh:
      return {select(StudyKernel::binary_bvh, in_double), {BvhLayout::bvh2}};
    case Queries::path_at_a_time:
    case Queries::of_backend:
      break;
  }
  return {select(StudyKernel::path_at_a_time, in_double), {BvhLayout::bvh8}};
}

}  // namespace study
}  // namespace alhazen::impl
