// A library with the functions of Open Image Denoise that the denoiser `oidn` calls. It checks how it is called, and
// its filters do what a test can tell: a filter of a feature adds 1 to it, and the one of colours adds both features to
// them. With MOCK_OIDN_VERSION_1 it has the names that version 1 has for two functions. The environment variable
// MOCK_OIDN_FAILS makes filters fail, and MOCK_OIDN_WANTS_THREADS those that run on another number of threads.

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>

namespace {

std::string error;
int devices = 0, filters = 0, threads = 0;
bool is_device_committed = false;

struct Image {
  float* data;
  size_t width, height;
};

struct Filter {
  std::map<std::string, Image> images;
  std::map<std::string, bool> flags;
  bool is_committed = false;
};

}  // namespace

#if defined(MOCK_OIDN_VERSION_1)
#define SET_DEVICE_INT oidnSetDevice1i
#define SET_FILTER_BOOL oidnSetFilter1b
#else
#define SET_DEVICE_INT oidnSetDeviceInt
#define SET_FILTER_BOOL oidnSetFilterBool
#endif

extern "C" {

void* oidnNewDevice(int type) {
  ++devices;
  if (type != 1) error = "not a device for the memory of the host";
  return &devices;
}
void SET_DEVICE_INT(void*, const char* name, int value) {
  if (std::strcmp(name, "numThreads") != 0 || value < 1 || is_device_committed) error = "not a number of threads";
  threads = value;
}
void oidnCommitDevice(void*) { is_device_committed = true; }
int oidnGetDeviceError(void*, const char** message) {
  static std::string reported;
  reported = error;
  error.clear();
  *message = reported.c_str();
  return reported.empty() ? 0 : 1;
}
void oidnReleaseDevice(void*) {
  is_device_committed = false;
  if (--devices != 0 || filters != 0) std::abort();
}
void* oidnNewFilter(void*, const char* type) {
  if (std::strcmp(type, "RT") != 0) return nullptr;
  ++filters;
  return new Filter;
}
void oidnSetSharedFilterImage(void* filter, const char* name, void* data, int format, size_t width, size_t height,
                              size_t offset, size_t pixel_bytes, size_t row_bytes) {
  if (format != 3 || offset != 0 || pixel_bytes != 0 || row_bytes != 0) error = "another format";
  static_cast<Filter*>(filter)->images[name] = {static_cast<float*>(data), width, height};
}
void SET_FILTER_BOOL(void* filter, const char* name, bool value) { static_cast<Filter*>(filter)->flags[name] = value; }
void oidnCommitFilter(void* filter) { static_cast<Filter*>(filter)->is_committed = true; }
void oidnExecuteFilter(void* pointer) {
  Filter& filter = *static_cast<Filter*>(pointer);
  if (std::getenv("MOCK_OIDN_FAILS")) error = "the mock fails";
  const char* const wanted = std::getenv("MOCK_OIDN_WANTS_THREADS");
  if (wanted && std::to_string(threads) != wanted) error = "runs on " + std::to_string(threads) + " threads";
  if (!filter.is_committed || !is_device_committed || filter.images.count("output") == 0) error = "not ready";
  if (!error.empty()) return;
  const Image& output = filter.images["output"];
  const size_t count = 3 * output.width * output.height;
  if (filter.images.count("color") == 0) {
    const Image& input = filter.images.begin()->second;  // "albedo" and "normal" are before "output"
    for (size_t i = 0; i < count; ++i) output.data[i] = input.data[i] + 1;
    return;
  }
  if (!filter.flags["hdr"] || !filter.flags["cleanAux"]) error = "not as asked for";
  for (size_t i = 0; i < count; ++i)
    output.data[i] =
        filter.images["color"].data[i] + filter.images["albedo"].data[i] + 2 * filter.images["normal"].data[i];
}
void oidnReleaseFilter(void* filter) {
  --filters;
  delete static_cast<Filter*>(filter);
}
}
