#include "backends/pixel_blocks.h"
#include "render/backend.h"

namespace alhazen::impl {

namespace {

/// The report's Algorithm 1: one thread renders the pixels one after the other.
class SerialBackend final : public Backend {
 public:
  BackendTraits traits() const override { return {"serial", {}, "one core"}; }
  BackendStatus status() const override { return {true, "one core, " + to_string(instruction_sets().back())}; }

  void configure(const Settings& asked, RenderSettings& settings) const override {
    Backend::configure(asked, settings);
    if (asked.backend == "serial") refuse_schedule(asked);  // not where it is the choice for one thread
    settings.threads = 1;
  }
  std::vector<NamedSetting> named_settings(const RenderSettings&) const override { return {{"schedule", ""}}; }

  void render_pass(const RenderPass<float>& pass) override { render(pass); }
  void render_pass(const RenderPass<double>& pass) override { render(pass); }

 private:
  template <class Real>
  static void render(const RenderPass<Real>& pass) {
    const PixelWindow& window = pass.film.window();
    ThreadStatistics& statistics = pass.control.thread(0);
    const BusyTimer timer(statistics);
    for (int y = window.y0; y < window.y1 && !pass.control.is_stopped(); ++y) {
      {
        BlockBatch<Real> batch(pass, statistics);
        for (int x = window.x0; x < window.x1; ++x) batch.add_pixel(x, y);
      }
      pass.control.add_samples(pass.film.unfinished(window.x0, window.x1, y, y + 1) * pass.sample_count);
    }
  }
};

}  // namespace

std::unique_ptr<Backend> make_serial_backend() { return std::make_unique<SerialBackend>(); }

}  // namespace alhazen::impl
