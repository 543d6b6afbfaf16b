#pragma once

// Where a study was measured and with what: nothing in it names the machine or its owner.

#include <string>
#include <vector>

namespace alhazen::study {

struct Engine {
  std::string name;
  bool available = false;
  std::string details;
  std::vector<std::string> devices;
};

struct Machine {
  std::string processor;
  int processors = 1;  ///< that a program may use
  std::string instructions;
  double memory_gib = 0;
  std::string system;
  std::string governor;  ///< of the frequency; empty: not known
  std::string compiler, flags, version;
  std::vector<Engine> engines;
};

Machine this_machine();

/// Processes that run or wait, averaged over a minute; 0 where that is not known.
double load_average();
/// The mean frequency of the processors now; 0 where that is not known.
double megahertz();
/// Today, as 2026-01-31.
std::string today();

}  // namespace alhazen::study
