// The denoiser `oidn`: Intel Open Image Denoise, if its library is on this machine.

#include <memory>
#include <optional>

#include "backends/oidn/oidn_library.h"
#include "render/denoiser.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

namespace {

using namespace oidn;

class OidnDenoiser final : public Denoiser {
 public:
  std::string name() const override { return "oidn"; }
  std::string details() const override {
    return "Intel Open Image Denoise, on the CPU" + (library().path.empty() ? "" : ": " + library().path);
  }
  std::string problem() const override { return library().problem; }
  std::string defect() const override { return library().is_here ? library().problem : std::string(); }

  std::vector<float> denoise(const NoisyImage& image, const DenoiseOptions& options) const override {
    if (!library().problem.empty()) throw UnsupportedError(library().problem);
    const Functions& f = library().functions;
    const std::unique_ptr<DeviceHandle, void (*)(DeviceHandle*)> device(f.new_device(device_type_cpu),
                                                                        f.release_device);
    if (!device) fail(nullptr, "starting");
    f.set_device_int(device.get(), "numThreads", options.threads);
    f.commit_device(device.get());
    check(device.get(), "starting");
    std::vector<float> radiance = image.radiance.mean, albedo = image.albedo.mean, normal = image.normal.mean;
    // Features are noisy in blurred parts. Filtered on their own before, they may be followed closely (manual, section
    // on prefiltering).
    run(device.get(), image, {{"albedo", &albedo}}, albedo, "filtering the albedo");
    run(device.get(), image, {{"normal", &normal}}, normal, "filtering the normals");
    std::vector<float> denoised(radiance.size());
    run(device.get(), image, {{"color", &radiance}, {"albedo", &albedo}, {"normal", &normal}}, denoised, "denoising");
    return denoised;
  }

 private:
  struct Input {
    const char* name;
    std::vector<float>* values;
  };

  /// Runs one filter. A filter of a feature alone may write over its input.
  void run(DeviceHandle* device, const NoisyImage& image, const std::vector<Input>& inputs, std::vector<float>& output,
           const char* doing) const {
    const Functions& f = library().functions;
    const std::unique_ptr<FilterHandle, void (*)(FilterHandle*)> filter(f.new_filter(device, "RT"), f.release_filter);
    if (!filter) fail(device, doing);
    const auto set = [&](const char* name, std::vector<float>& values) {
      f.set_shared_filter_image(filter.get(), name, values.data(), format_float3, static_cast<size_t>(image.width),
                                static_cast<size_t>(image.height), 0, 0, 0);
    };
    for (const Input& input : inputs) set(input.name, *input.values);
    set("output", output);
    if (inputs.size() > 1) {
      f.set_filter_bool(filter.get(), "hdr", true);
      f.set_filter_bool(filter.get(), "cleanAux", true);
    }
    f.commit_filter(filter.get());
    check(device, doing);
    f.execute_filter(filter.get());
    check(device, doing);
  }

  void check(DeviceHandle* device, const char* doing) const {
    const char* message = nullptr;
    if (library().functions.get_device_error(device, &message) != error_none) refuse(doing, message);
  }

  /// A null handle is an error of its own, even if none is reported.
  [[noreturn]] void fail(DeviceHandle* device, const char* doing) const {
    const char* message = nullptr;
    library().functions.get_device_error(device, &message);
    refuse(doing, message);
  }

  [[noreturn]] static void refuse(const char* doing, const char* message) {
    throw RenderError(std::string("Open Image Denoise failed while ") + doing + ": " +
                      (message && *message ? message : "no reason was given"));
  }

  /// Opens the library when it is first asked about, since the list of denoisers is also made for their names alone.
  const Library& library() const {
    if (!library_) library_ = open_library();
    return *library_;
  }

  mutable std::optional<Library> library_;
};

}  // namespace

std::unique_ptr<Denoiser> make_oidn_denoiser() { return std::make_unique<OidnDenoiser>(); }

}  // namespace alhazen::impl
