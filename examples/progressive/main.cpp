// Shows an image while it grows: writes so_far.png after every pass, until its noise is low enough for you (Ctrl-C) or
// all samples are taken. A viewer that reloads the file, such as feh or eog, shows the progress.

#include <alhazen/renderer.h>
#include <alhazen/save.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>

namespace {
std::atomic<bool> is_interrupted{false};
}

int main(int argc, char** argv) try {
  if (argc < 2) return std::fprintf(stderr, "usage: progressive SCENE [SAMPLES]\n"), 2;
  std::signal(SIGINT, [](int) { is_interrupted = true; });

  const alhazen::Scene scene = alhazen::Scene::load(argv[1]);
  for (const alhazen::Warning& warning : scene.warnings()) std::printf("warning: %s\n", warning.text().c_str());

  alhazen::Settings settings;
  settings.width = 320, settings.height = 240;
  settings.samples_per_pixel = argc > 2 ? std::atoi(argv[2]) : 256;
  alhazen::Renderer renderer(settings);
  renderer.start(scene, [](const alhazen::Progress&) { return !is_interrupted; });
  // Few samples first, so that something is to be seen soon; then twice as many each time.
  int64_t samples = 4;
  while (renderer.render_pass(samples)) {
    alhazen::save(renderer.image(), "so_far.png");
    std::printf("%3.0f %%\n", 100 * renderer.progress().fraction);
    samples *= 2;
  }
  const alhazen::RenderedImage image = renderer.finish();
  if (image.planes.empty()) return std::printf("interrupted before the first sample\n"), 0;
  alhazen::save(image, "so_far.png");
  std::printf("so_far.png: %s\n", image.complete ? "complete" : "interrupted");
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 2;
}
