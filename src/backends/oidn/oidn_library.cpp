#include "backends/oidn/oidn_library.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <vector>

#include "util/module.h"

namespace alhazen::impl::oidn {

namespace {

namespace fs = std::filesystem;

constexpr const char* names[] = {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1"};
constexpr const char* how_to_get =
    "install Intel Open Image Denoise, version 1.4 or later (https://www.openimagedenoise.org), or set "
    "ALHAZEN_OIDN_PATH to its library or the folder that has it";

/// Returns the name of the function that `handle` lacks, or null if it has all.
const char* find_functions(void* handle, Functions& functions) {
  const auto find = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(handle, name));
    return function != nullptr;
  };
  if (!find(functions.new_device, "oidnNewDevice")) return "oidnNewDevice";
  // Version 1 calls this one, and the other below, otherwise.
  if (!find(functions.set_device_int, "oidnSetDeviceInt") && !find(functions.set_device_int, "oidnSetDevice1i"))
    return "oidnSetDeviceInt";
  if (!find(functions.commit_device, "oidnCommitDevice")) return "oidnCommitDevice";
  if (!find(functions.get_device_error, "oidnGetDeviceError")) return "oidnGetDeviceError";
  if (!find(functions.release_device, "oidnReleaseDevice")) return "oidnReleaseDevice";
  if (!find(functions.new_filter, "oidnNewFilter")) return "oidnNewFilter";
  if (!find(functions.set_shared_filter_image, "oidnSetSharedFilterImage")) return "oidnSetSharedFilterImage";
  if (!find(functions.set_filter_bool, "oidnSetFilterBool") && !find(functions.set_filter_bool, "oidnSetFilter1b"))
    return "oidnSetFilterBool";
  if (!find(functions.commit_filter, "oidnCommitFilter")) return "oidnCommitFilter";
  if (!find(functions.execute_filter, "oidnExecuteFilter")) return "oidnExecuteFilter";
  if (!find(functions.release_filter, "oidnReleaseFilter")) return "oidnReleaseFilter";
  return nullptr;
}

Library use(const std::string& path, void* handle) {
  Library library{path, {}, {}, true};
  if (const char* const lacking = find_functions(handle, library.functions)) {
    dlclose(handle);
    library.problem =
        path + " is no library of Open Image Denoise: it lacks the function " + lacking + "; " + how_to_get;
  }
  return library;
}

Library refuse(const std::string& path, const std::string& reason) { return {path, {}, path + reason, true}; }

Library cannot_be_loaded(const std::string& path, const std::string& reason) {
  return refuse(path, " cannot be loaded: " + (reason.empty() ? "no reason was given" : reason) + "; " + how_to_get);
}

std::string loader_error() {
  const char* const text = dlerror();
  return text ? text : "";
}

Library open_file(const std::string& path) {
  if (void* const handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) return use(path, handle);
  return cannot_be_loaded(path, loader_error());
}

/// Opens what the dynamic linker finds. Its error begins with the name of the file that it did not find; where that is
/// another one, such as a library that this one needs, or where it found a file that it cannot load, this one is here.
std::optional<Library> open_installed(const std::string& name) {
  if (void* const handle = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL)) return use(name, handle);
  const std::string error = loader_error();
  if (error.rfind(name + ": cannot open shared object file: No such file", 0) == 0) return std::nullopt;
  return cannot_be_loaded(name, error);
}

/// Returns the library in `folder`, or an empty path.
std::string library_in(const fs::path& folder) {
  std::error_code error;
  for (const char* const name : names)
    if (fs::exists(folder / name, error)) return (folder / name).string();
  return {};
}

}  // namespace

Library open_library() {
  std::error_code error;
  if (const char* const asked = std::getenv("ALHAZEN_OIDN_PATH"); asked && *asked) {
    if (!fs::exists(asked, error))
      return refuse(asked, std::string(", which ALHAZEN_OIDN_PATH names, does not exist; ") + how_to_get);
    if (!fs::is_directory(asked, error)) return open_file(asked);
    const std::string path = library_in(asked);
    if (!path.empty()) return open_file(path);
    return refuse(asked, std::string(", which ALHAZEN_OIDN_PATH names, has no ") + names[0] + " or " + names[1] + "; " +
                             how_to_get);
  }
  const fs::path modules = module_folder();
  for (const fs::path& folder : {modules, modules.parent_path()})
    if (const std::string path = library_in(folder); !path.empty()) return open_file(path);
  for (const char* const name : names)
    if (const std::optional<Library> library = open_installed(name)) return *library;
  return {{}, {}, std::string(names[0]) + " is not on this machine: " + how_to_get, false};
}

}  // namespace alhazen::impl::oidn
