#include "render/denoiser.h"

#include "util/diagnostics.h"

namespace alhazen {

std::unique_ptr<Denoiser> make_denoiser(const std::string& name) {
  std::string names;
  for (std::unique_ptr<Denoiser>& denoiser : all_denoisers()) {
    if (denoiser->name() == name) return std::move(denoiser);
    names += ", " + denoiser->name();
  }
  throw InputError("unknown denoiser '" + name + "': it may be none" + names);
}

}  // namespace alhazen
