#pragma once

// The renderer behind alhazen.Renderer.

#include <atomic>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "alhazen/renderer.h"
#include "bindings.h"
#include "python_scene.h"

namespace alhazen::python {

/// All functions but `stop` need the GIL, and release it while they work. One thread at a time may use it, which is
/// checked; `stop` may be called at any time.
class PythonRenderer {
 public:
  explicit PythonRenderer(const alhazen::Settings& settings) : renderer_(settings) {}
  ~PythonRenderer();

  const alhazen::Settings& settings() const { return renderer_.settings(); }
  void set_settings(const alhazen::Settings& settings);
  BuildReport start(const PythonScene& scene, const py::object& progress);
  bool render_pass(int64_t samples);
  RenderedImage image();
  RenderedImage denoised_image();
  Progress progress();
  void stop() { renderer_.stop(); }
  RenderedImage finish();
  /// `self` is what `after_pass`, a function or None, gets.
  RenderedImage render(const PythonScene& scene, const py::object& progress, const py::object& after_pass,
                       const py::object& self);
  std::vector<std::string> warnings();

 private:
  /// Uses the renderer alone as long as it exists.
  class Use;
  /// Throws Error unless this thread may look at the image: nobody else uses the renderer, or `after_pass` runs here.
  void check_looking() const;
  template <class Result, class Call>
  Result run(const Call& call, bool drops_image);
  void issue_warnings();

  alhazen::Renderer renderer_;
  bool is_used_ = false;
  std::thread::id callback_thread_;  ///< that runs `after_pass`
  std::shared_ptr<std::atomic<bool>> is_dropped_ = std::make_shared<std::atomic<bool>>(false);
  std::set<std::string> issued_;  ///< warnings
};

}  // namespace alhazen::python
