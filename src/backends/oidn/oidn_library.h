#pragma once

// The few functions of Intel Open Image Denoise that the denoiser `oidn` calls, looked up in its library at run time.
// They are declared after the manual of its C interface (https://www.openimagedenoise.org/documentation.html), which
// versions 1 and 2 share but for two names.

#include <cstddef>
#include <string>

namespace alhazen::impl::oidn {

struct DeviceHandle;
struct FilterHandle;

inline constexpr int device_type_cpu = 1, format_float3 = 3, error_none = 0;

struct Functions {
  DeviceHandle* (*new_device)(int type);
  void (*set_device_int)(DeviceHandle*, const char* name, int value);
  void (*commit_device)(DeviceHandle*);
  int (*get_device_error)(DeviceHandle*, const char** message);
  void (*release_device)(DeviceHandle*);
  FilterHandle* (*new_filter)(DeviceHandle*, const char* type);
  void (*set_shared_filter_image)(FilterHandle*, const char* name, void* data, int format, size_t width, size_t height,
                                  size_t byte_offset, size_t pixel_bytes, size_t row_bytes);
  void (*set_filter_bool)(FilterHandle*, const char* name, bool value);
  void (*commit_filter)(FilterHandle*);
  void (*execute_filter)(FilterHandle*);
  void (*release_filter)(FilterHandle*);
};

struct Library {
  std::string path;       ///< as it was opened; empty if there is none
  Functions functions{};  ///< valid if `problem` is empty
  std::string problem;    ///< why it cannot be used, and what to do
  bool is_here = false;   ///< a library was found or named, even if it cannot be used
};

/// Opens the library that the environment variable ALHAZEN_OIDN_PATH names (a file, or the folder of one), else the one
/// beside libalhazen.so or in the folder of modules, else the one that the dynamic linker finds.
Library open_library();

}  // namespace alhazen::impl::oidn
