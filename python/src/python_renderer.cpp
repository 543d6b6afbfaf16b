#include "python_renderer.h"

#include <optional>
#include <utility>

#include "convert.h"
#include "interruptible.h"
#include "progress.h"
#include "python_warnings.h"

namespace alhazen::python {

class PythonRenderer::Use {
 public:
  explicit Use(PythonRenderer& renderer) : renderer_(renderer) {
    if (renderer.is_used_)
      throw Error(
          "the renderer is in use: until that ends, stop() alone may be called, and image(), progress and "
          "warnings by the function that is called after passes");
    renderer.is_used_ = true;
  }
  ~Use() { renderer_.is_used_ = false; }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  PythonRenderer& renderer_;
};

/// An image under way ends, whose last progress may need the GIL on another thread.
PythonRenderer::~PythonRenderer() {
  const Unlocked unlocked;
  *is_dropped_ = true;
  const alhazen::Renderer dropped = std::move(renderer_);
}

void PythonRenderer::check_looking() const {
  if (is_used_ && callback_thread_ != std::this_thread::get_id())
    throw Error("the renderer is in use by another thread: wait until that ends");
}

/// Of an image that was dropped, a call is one at the wrong time.
template <class Result, class Call>
Result PythonRenderer::run(const Call& call, bool drops_image) {
  std::optional<Result> result;
  try {
    run_interruptible([&] { result = call(); },
                      [&] {
                        if (drops_image) *is_dropped_ = true;
                        renderer_.stop();
                      });
  } catch (const RenderDropped&) {
    throw InputError("no image is under way: call start first");
  }
  return std::move(*result);
}

void PythonRenderer::issue_warnings() { issue_new_warnings(warning_texts(renderer_.warnings()), issued_); }

void PythonRenderer::set_settings(const alhazen::Settings& settings) {
  const Use use(*this);
  renderer_.set_settings(settings);
}

BuildReport PythonRenderer::start(const PythonScene& scene, const py::object& progress) {
  const Use use(*this);
  const SceneReading reading(scene);
  const auto is_dropped = std::make_shared<std::atomic<bool>>(false);
  const ProgressFunction function = progress_function(progress, is_dropped);
  const auto report = run<BuildReport>(
      [&] {
        const BuildReport started = renderer_.start(reading.scene(), function);
        is_dropped_ = is_dropped;
        return started;
      },
      true);
  issue_warnings();
  return report;
}

bool PythonRenderer::render_pass(int64_t samples) {
  const Use use(*this);
  return run<bool>([&] { return renderer_.render_pass(samples); }, false);
}

RenderedImage PythonRenderer::image() {
  check_looking();
  std::optional<Use> use;
  if (!is_used_) use.emplace(*this);
  const Unlocked unlocked;
  return renderer_.image();
}

RenderedImage PythonRenderer::denoised_image() {
  const Use use(*this);
  auto image = run<RenderedImage>([&] { return renderer_.denoised_image(); }, false);
  issue_warnings();
  return image;
}

Progress PythonRenderer::progress() {
  check_looking();
  return renderer_.progress();
}

std::vector<std::string> PythonRenderer::warnings() {
  check_looking();
  return warning_texts(renderer_.warnings());
}

RenderedImage PythonRenderer::finish() {
  const Use use(*this);
  auto image = run<RenderedImage>([&] { return renderer_.finish(); }, false);
  issue_warnings();
  return image;
}

RenderedImage PythonRenderer::render(const PythonScene& scene, const py::object& progress, const py::object& after_pass,
                                     const py::object& self) {
  const Use use(*this);
  const SceneReading reading(scene);
  if (!after_pass.is_none() && PyCallable_Check(after_pass.ptr()) == 0)
    refuse_given("after_pass", "a function or None", after_pass);
  is_dropped_ = std::make_shared<std::atomic<bool>>(false);
  const ProgressFunction function = progress_function(progress, is_dropped_);
  const auto call_after_pass = [&](const alhazen::Renderer&) {
    if (*is_dropped_) return false;
    if (after_pass.is_none()) return true;
    const py::gil_scoped_acquire locked;
    callback_thread_ = std::this_thread::get_id();
    try {
      const bool goes_on = !says_stop(after_pass(self));
      callback_thread_ = {};
      return goes_on;
    } catch (...) {
      callback_thread_ = {};
      throw;
    }
  };
  auto image = run<RenderedImage>([&] { return renderer_.render(reading.scene(), function, call_after_pass); }, true);
  issue_warnings();
  return image;
}

}  // namespace alhazen::python
