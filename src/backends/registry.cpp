// Lists all backends and denoisers, in the order in which they are displayed; of denoisers the best first. A new folder
// of src/backends is registered by its name here.

#include "render/backend.h"
#include "render/denoiser.h"

#define ALHAZEN_BACKENDS(X) X(serial) X(openmp) X(embree) X(cuda) X(optix)
#define ALHAZEN_DENOISERS(X) X(optix) X(oidn) X(builtin)

namespace alhazen::impl {

#define ALHAZEN_DECLARE_BACKEND(name) std::unique_ptr<Backend> make_##name##_backend();
ALHAZEN_BACKENDS(ALHAZEN_DECLARE_BACKEND)
#define ALHAZEN_DECLARE_DENOISER(name) std::unique_ptr<Denoiser> make_##name##_denoiser();
ALHAZEN_DENOISERS(ALHAZEN_DECLARE_DENOISER)

std::vector<std::unique_ptr<Backend>> all_backends() {
  std::vector<std::unique_ptr<Backend>> backends;
#define ALHAZEN_MAKE_BACKEND(name) backends.push_back(make_##name##_backend());
  ALHAZEN_BACKENDS(ALHAZEN_MAKE_BACKEND)
  return backends;
}

std::string default_backend(int threads) { return threads > 1 ? "openmp" : "serial"; }

std::vector<std::unique_ptr<Denoiser>> all_denoisers() {
  std::vector<std::unique_ptr<Denoiser>> denoisers;
#define ALHAZEN_MAKE_DENOISER(name) denoisers.push_back(make_##name##_denoiser());
  ALHAZEN_DENOISERS(ALHAZEN_MAKE_DENOISER)
  return denoisers;
}

}  // namespace alhazen::impl
