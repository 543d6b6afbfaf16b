#pragma once

// The compiled device programs, as bytes in the binary (cmake/Optix.cmake makes them).

#include <cstddef>
#include <span>

namespace alhazen::optix {

struct DeviceCode {
  std::span<const unsigned char> optix_ir;
  std::span<const unsigned char> ptx;  ///< for drivers that do not take the former
};

DeviceCode device_code();

}  // namespace alhazen::optix
