#pragma once

// Names of rows and columns of a study's tables that its conclusions look up.

namespace alhazen::impl::study::name {

inline constexpr const char* branching = "branching (Algorithm 2)";
inline constexpr const char* recursive = "recursive (Algorithm 3)";
inline constexpr const char* iterative = "iterative (Algorithm 5)";
inline constexpr const char* one_core = "one core";
inline constexpr const char* single = "a path at a time";
inline constexpr const char* batches = "in batches";
inline constexpr const char* core_in_batches = "one core, batches";
inline constexpr const char* wide_bvh = "wide BVH, SIMD";
inline constexpr const char* binary_bvh = "binary BVH";
inline constexpr const char* embree = "Embree";
inline constexpr const char* optix = "OptiX";
inline constexpr const char* cuda_persistent = "CUDA persistent";

}  // namespace alhazen::impl::study::name
