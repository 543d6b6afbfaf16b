// Renders a scene into memory, shows progress, and stops early if a second argument gives a time limit in seconds.
// An exception from the progress function stops the render too, and is caught below like the errors of the library.

#include <alhazen/alhazen.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <stdexcept>

int main(int argc, char** argv) try {
  if (argc < 2) return std::fprintf(stderr, "usage: render_to_memory SCENE.pbrt [SECONDS]\n"), 2;
  const double seconds = argc > 2 ? std::atof(argv[2]) : std::numeric_limits<double>::infinity();

  alhazen::Settings settings;
  settings.width = settings.height = 100;
  settings.samples_per_pixel = 1024;
  settings.aovs = {"depth"};

  const alhazen::RenderedImage image = alhazen::render(argv[1], settings, [&](const alhazen::Progress& progress) {
    if (std::printf("%3.0f%%\n", 100 * progress.fraction) < 0) throw std::runtime_error("nobody reads the progress");
    return progress.seconds < seconds;  // false cancels
  });
  for (const alhazen::Warning& warning : image.warnings) std::printf("warning: %s\n", warning.text().c_str());

  if (image.planes.empty()) return std::printf("cancelled before the first sample\n"), 0;
  const float *red = image.plane("R"), *depth = image.plane("depth.Z");
  const int centre = image.height / 2 * image.width + image.width / 2;
  std::printf("%d x %d pixels, %s; in the centre red is %.3f and the depth %.3f\n", image.width, image.height,
              image.complete ? "complete" : "cancelled", double{red[centre]}, double{depth[centre]});
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 2;
}
