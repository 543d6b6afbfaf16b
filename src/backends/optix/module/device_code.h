#pragma once

// The compiled device programs, embedded as bytes by cmake/Optix.cmake.

#include <cstddef>
#include <span>

namespace alhazen::impl::optix {

struct DeviceCode {
  std::span<const unsigned char> optix_ir;
  std::span<const unsigned char> ptx;  ///< for drivers that reject the OptiX IR
};

DeviceCode device_code();

}  // namespace alhazen::impl::optix
