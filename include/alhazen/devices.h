#pragma once

// What this machine can render with: what `alhazen devices` lists.

#include <string>
#include <vector>

#include "alhazen/version.h"

namespace ALHAZEN_NAMESPACE {

/// A value of Settings::backend.
struct BackendInfo {
  std::string name;
  bool available = false;
  std::string details;               ///< what it runs on; or why it cannot, and what to do
  std::vector<std::string> devices;  ///< its GPUs, in the order of their numbers
  std::vector<std::string> strategies;
  std::string module;  ///< the file that it was loaded from; empty: it is part of the library
};

/// A value of Settings::denoiser.
struct DenoiserInfo {
  std::string name;
  bool available = false;
  std::string details;  ///< what it runs on; or why it cannot, and what to do
};

struct Devices {
  std::vector<BackendInfo> backends;
  std::vector<DenoiserInfo> denoisers;
  std::string processor;                      ///< model name of the CPU
  int processors = 1;                         ///< hardware threads that this process may use
  std::vector<std::string> instruction_sets;  ///< what kernels on CPUs are built for
};

/// Loads the modules of all backends, which may take a second where there are GPUs.
Devices devices();

}  // namespace ALHAZEN_NAMESPACE
