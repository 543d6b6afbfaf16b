#include "study/machine.h"

#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <thread>

#include "render/backend.h"
#include "study/build_id.h"

namespace alhazen::impl::study {

namespace {

/// Calls line(name, value) for every "name : value" of /proc/cpuinfo.
template <class Line>
void read_cpuinfo(const Line& line) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string text; std::getline(file, text);) {
    const size_t colon = text.find(':');
    if (colon == std::string::npos) continue;
    const size_t end = text.find_last_not_of(" \t", colon - 1);
    line(text.substr(0, end + 1), colon + 2 < text.size() ? text.substr(colon + 2) : std::string());
  }
}

std::string first_word_of(const char* path) {
  std::string word;
  std::ifstream(path) >> word;
  return word;
}

}  // namespace

std::string processor_name() {
  std::string model, family, number;
  read_cpuinfo([&](const std::string& name, const std::string& value) {
    if (name == "model name") model = value;
    if (name == "cpu family") family = value;
    if (name == "model") number = value;
  });
  if (model.empty()) return "unknown";
  return family.empty() ? model : model + " (family " + family + ", model " + number + ")";
}

Machine this_machine() {
  Machine m;
  m.processor = processor_name();
  m.processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  m.instructions = to_string(instruction_sets().back());
  m.memory_gib = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE)) * 0x1p-30;
  utsname names{};
  if (uname(&names) == 0) {
    const std::string release = names.release;
    const std::string kernel = release.substr(0, release.find('.', release.find('.') + 1));
    m.system = std::string(names.sysname) + " " + kernel + " " + names.machine;
  }
  m.governor = first_word_of("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
#if defined(__clang__)
  m.compiler = __VERSION__;
#else
  m.compiler = std::string("GCC ") + __VERSION__;
#endif
  m.flags = ALHAZEN_BUILD_FLAGS;
  m.version = version();
  m.build = build_id();
  for (const auto& backend : all_backends()) {
    const BackendStatus status = backend->status();
    m.engines.push_back({backend->traits().name, status.available, status.details, status.devices});
  }
  return m;
}

double load_average() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? load : 0;
}

double megahertz() {
  double sum = 0;
  int count = 0;
  read_cpuinfo([&](const std::string& name, const std::string& value) {
    if (name != "cpu MHz") return;
    sum += std::strtod(value.c_str(), nullptr);
    ++count;
  });
  return count > 0 ? sum / count : 0;
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[16];
  std::strftime(text, sizeof(text), "%Y-%m-%d", &local);
  return text;
}

}  // namespace alhazen::impl::study
