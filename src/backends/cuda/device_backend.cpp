#include "backends/cuda/device_backend.h"

#include <charconv>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

#include "backends/pixel_blocks.h"
#include "util/thread_limit.h"

namespace alhazen::impl::cuda {

int DeviceBackend::parse_device(const std::string& text) const {
  const bool has_host = traits().runs_on_host;
  if (text == "host" && has_host) return host_device;
  require_available();
  if (text == "all") return all_devices;
  const int count = static_cast<int>(status().devices.size());
  int device = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), device);
  if (error != std::errc() || end != text.data() + text.size() || device < 0 || device >= count)
    throw InputError("there is no device '" + text + "': it may be " + (has_host ? "host, " : "") +
                     "all or a number from 0 to " + std::to_string(count - 1) + "; 'alhazen devices' lists them");
  return device;
}

/// Each device counts as one thread, since the statistics have one entry per thread.
void DeviceBackend::configure(const Settings& asked, RenderSettings& settings) const {
  settings.runs_on_device = true;
  settings.device = parse_device(asked.device.empty() ? "0" : asked.device);
  settings.threads = settings.device == all_devices ? static_cast<int>(status().devices.size()) : 1;
  if (settings.integrator != IntegratorKind::path && settings.integrator != IntegratorKind::iterative)
    throw InputError("the backend '" + traits().name + "' has no integrator '" + to_string(settings.integrator) +
                     "', which calls itself: it may be path, iterative");
  configure_blocks(asked, settings);
  refuse_schedule(asked);
}

std::vector<NamedSetting> DeviceBackend::named_settings(const RenderSettings& settings) const {
  std::vector<NamedSetting> named = Backend::named_settings(settings);
  const int device = settings.device;
  named.emplace_back("device", device == host_device ? "host" : device == all_devices ? "all" : std::to_string(device));
  return named;
}

void DeviceBackend::start(const RenderSettings& settings) {
  if (settings.device != all_devices) {
    engines_.push_back(make_engine(settings.device, {}, settings.precision));
    return;
  }
  const uint32_t count = static_cast<uint32_t>(list_devices().devices.size());
  for (uint32_t i = 0; i < count; ++i)
    engines_.push_back(make_engine(static_cast<int>(i), {i, count}, settings.precision));
}

template <class Action>
void DeviceBackend::on_every_engine(const Action& action) {
  if (engines_.size() == 1) return action(*engines_[0], 0);
  std::exception_ptr failure;
  std::mutex mutex;
  std::vector<std::thread> threads;
  const auto keep_failure = [&] {
    const std::lock_guard lock(mutex);
    failure = std::current_exception();
  };
  threads.reserve(engines_.size());
  try {
    for (size_t i = 0; i < engines_.size(); ++i)
      threads.push_back(start_thread("the thread of GPU " + std::to_string(i), [&, i] {
        try {
          action(*engines_[i], static_cast<int>(i));
        } catch (...) {
          keep_failure();
        }
      }));
  } catch (...) {  // those that have started are waited for
    keep_failure();
  }
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}

void DeviceBackend::prepare(const CompiledScene<float>& scene) {
  on_every_engine([&](Engine& engine, int) { engine.prepare(scene); });
}

template <class Real>
void DeviceBackend::render(const RenderPass<Real>& pass) {
  on_every_engine([&](Engine& engine, int index) {
    ThreadStatistics& statistics = pass.control.thread(index);
    const BusyTimer timer(statistics);
    try {
      engine.render_pass(pass, statistics);
    } catch (...) {
      pass.control.stop();
      throw;
    }
  });
}

void DeviceBackend::render_pass(const RenderPass<float>& pass) { render(pass); }
void DeviceBackend::render_pass(const RenderPass<double>& pass) { render(pass); }

std::vector<std::string> describe_devices() {
  std::vector<std::string> lines;
  for (const DeviceInfo& d : list_devices().devices) {
    char text[64];
    std::snprintf(text, sizeof(text), ", compute capability %d.%d, %.1f GiB, %d SMs", d.major, d.minor,
                  static_cast<double>(d.memory) / (1 << 30), d.multiprocessors);
    lines.push_back(d.name + text);
  }
  return lines;
}

}  // namespace alhazen::impl::cuda
