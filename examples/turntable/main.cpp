// Renders a turn about a scene: frame_000.png, frame_001.png, ... The scene is read once and its BVH built once.

#include <alhazen/renderer.h>
#include <alhazen/save.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

int main(int argc, char** argv) try {
  if (argc < 3) return std::fprintf(stderr, "usage: turntable SCENE FRAMES [SAMPLES]\n"), 2;
  const int frames = std::atoi(argv[2]);

  alhazen::Scene scene = alhazen::Scene::load(argv[1]);
  alhazen::Film film = scene.film();
  film.width = 320, film.height = 240;
  scene.set_film(film);

  alhazen::Settings settings;
  settings.samples_per_pixel = argc > 3 ? std::atoi(argv[3]) : 64;
  alhazen::Renderer renderer(settings);
  for (int frame = 0; frame < frames; ++frame) {
    scene.orbit(360.0 * frame / frames, 20);
    const alhazen::BuildReport built = renderer.start(scene);
    while (renderer.render_pass()) {
    }
    char name[32];
    std::snprintf(name, sizeof(name), "frame_%03d.png", frame);
    alhazen::save(renderer.finish(), name);
    std::printf("%s: %s in %.0f ms\n", name, built.is_new ? "built" : "not built again, begun", 1e3 * built.seconds);
  }
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 2;
}
