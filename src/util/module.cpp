#include "util/module.h"

#include <alhazen_interface.h>
#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>

#include "util/module_file.h"

namespace alhazen::impl {

namespace {

namespace fs = std::filesystem;

#ifndef ALHAZEN_STATIC

/// Returns how a module differs from the program, or an empty string if it does not.
std::string explain_difference(const ModuleIdentity& module, const std::string& name) {
  if (module.name != name) return "is the module '" + std::string(module.name) + "' under another name";
  if (module.version == std::string(ALHAZEN_VERSION) && module.interface == std::string(ALHAZEN_INTERFACE_HASH))
    return "";
  return "was built from other sources than this program (version " + std::string(module.version) + ", interface " +
         module.interface + "; the program has version " ALHAZEN_VERSION ", interface " ALHAZEN_INTERFACE_HASH ")";
}

/// Turns the dynamic linker's error into a message.
std::string explain_load_error(const std::string& path) {
  const char* const text = dlerror();
  const std::string reason = text ? text : "no reason was given";
  const size_t end = reason.find(": cannot open shared object file");
  if (end == std::string::npos) return path + " cannot be loaded: " + reason;
  return path + " needs the library " + reason.substr(0, end) + ", which is not on this machine: install it";
}

#endif

}  // namespace

std::string module_folder() {
  if (const char* const folder = std::getenv("ALHAZEN_MODULES"); folder && *folder) return folder;
  Dl_info here{};
  if (dladdr(reinterpret_cast<const void*>(&module_folder), &here) == 0 || !here.dli_fname) return "alhazen";
  std::error_code error;
  const fs::path library = fs::canonical(here.dli_fname, error);
  return ((error ? fs::path(here.dli_fname) : library).parent_path() / "alhazen").string();
}

#ifdef ALHAZEN_STATIC  // as in the archive (cmake/StaticLibrary.cmake)

Module open_module(const std::string&, const std::string& name, const std::string&) {
  // A module would bring the shared library with it, and a second copy of all state.
  return {
      "", nullptr,
      "its module libalhazen_" + name +
          ".so needs the shared library, and this program is linked to the static one: link it to alhazen::alhazen"};
}

#else

Module open_module(const std::string& folder, const std::string& name, const std::string& how_to_get) {
  const std::string file = "libalhazen_" + name + ".so", path = (fs::path(folder) / file).string();
  std::error_code error;
  if (!fs::exists(path, error))
    return {"", nullptr,
            "its module " + file + " is not in " + folder + ": " + how_to_get +
                ", or set ALHAZEN_MODULES to the folder that has it"};
  const std::optional<ModuleIdentity> identity = read_module_identity(path);
  if (!identity) return {path, nullptr, path + " is damaged, or no module of Alhazen: build or install it again"};
  const std::string difference = explain_difference(*identity, name);
  if (!difference.empty()) return {path, nullptr, path + " " + difference + ": build or install the two together"};
  void* const handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) return {path, nullptr, explain_load_error(path)};
  using Functions = const void*();
  auto* const functions = reinterpret_cast<Functions*>(dlsym(handle, "alhazen_module_functions"));
  if (!functions) return {path, nullptr, path + " exports no functions: build or install it again"};
  return {path, functions(), ""};
}

#endif

}  // namespace alhazen::impl
