#pragma once

// The machine and the build of a study, without anything that identifies the machine or its owner.

#include <string>
#include <vector>

namespace alhazen::impl::study {

struct Engine {
  std::string name;
  bool available = false;
  std::string details;
  std::vector<std::string> devices;
};

struct Machine {
  std::string processor;
  int processors = 1;  ///< available to this process
  std::string instructions;
  double memory_gib = 0;
  std::string system;
  std::string governor;  ///< frequency governor; empty: unknown
  std::string compiler, flags, version;
  std::string build;  ///< build_id()
  std::vector<Engine> engines;
};

Machine this_machine();

/// The model of the processor, with its family and model numbers; "unknown" where the system does not say.
std::string processor_name();

/// Number of running or waiting processes, averaged over a minute; 0 if unknown.
double load_average();
/// The current mean frequency of the processors; 0 if unknown.
double megahertz();
/// The date, as 2026-01-31.
std::string today();

}  // namespace alhazen::impl::study
