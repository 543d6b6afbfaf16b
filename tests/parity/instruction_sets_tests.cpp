// The sample kernels give the same bits for every instruction set.

#include <gtest/gtest.h>

#include <cstring>

#include "parity/scenes.h"
#include "render/sample_kernel.h"
#include "support/compiled_scenes.h"

namespace alhazen::impl::test {
namespace {

template <class Real>
std::vector<BlockSum<Real>> take_image(const CompiledScene<Real>& flat, IntegratorKind integrator, SamplerType sampler,
                                       InstructionSet set) {
  std::vector<BlockRequest> requests;
  for (uint32_t y = 0; y < parity_height; ++y)
    for (uint32_t x = 0; x < parity_height; ++x) requests.push_back({x, y, 4, 1 + (x + y) % 4});
  std::vector<BlockSum<Real>> sums(requests.size());
  const SampleKernel<Real> kernel = select_sample_kernel<Real>(integrator, sampler, set);
  for (size_t i = 0; i < requests.size(); i += max_blocks_per_request)
    kernel(flat.view, nullptr, 7, 8, &requests[i],
           static_cast<uint32_t>(std::min<size_t>(max_blocks_per_request, requests.size() - i)), &sums[i]);
  return sums;
}

template <class Real>
void expect_same_bits(const std::string& name) {
  const CompiledScene<Real> flat = test::compiled_scene<Real>(parity_scene(name));
  for (const IntegratorKind integrator : {IntegratorKind::path, IntegratorKind::recursive})
    for (const SamplerType sampler : {SamplerType::sobol, SamplerType::independent}) {
      const auto expected = take_image(flat, integrator, sampler, InstructionSet::baseline);
      EXPECT_GT(expected[expected.size() / 2].segments, 0u);
      for (const InstructionSet set : instruction_sets()) {
        const auto sums = take_image(flat, integrator, sampler, set);
        EXPECT_EQ(std::memcmp(sums.data(), expected.data(), sums.size() * sizeof(sums[0])), 0)
            << name << ", " << to_string(set);
      }
    }
}

constexpr const char* every_scene[] = {"cornell",   "spheres", "environments", "lights", "materials",
                                       "instances", "meshes",  "cylinders",    "disks"};

TEST(InstructionSets, GiveTheSameBitsInFloat) {
  for (const char* name : every_scene) expect_same_bits<float>(name);
}

TEST(InstructionSets, GiveTheSameBitsInDouble) {
  for (const char* name : every_scene) expect_same_bits<double>(name);
}

}  // namespace
}  // namespace alhazen::impl::test
