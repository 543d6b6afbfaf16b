#pragma once

// Suggestions for misspelt names, and for names of pbrt-v3.

#include <string>
#include <string_view>

#include "util/suggestion.h"

namespace alhazen::impl::pbrt {

/// The end of the message for an unknown name: what to do if it is one of pbrt-v3 that pbrt-v4 removed, else
/// `otherwise`.
inline std::string or_upgrade(std::string_view name, const std::string& otherwise) {
  constexpr std::string_view names_of_v3[] = {
      "image",          "area",         "color",       "matte",          "plastic",           "substrate",
      "glass",          "metal",        "mirror",      "uber",           "translucent",       "disney",
      "fourier",        "kdsubsurface", "02sequence",  "lowdiscrepancy", "maxmindist",        "random",
      "directlighting", "whitted",      "heightfield", "nurbs",          "SurfaceIntegrator", "VolumeIntegrator"};
  for (const std::string_view old : names_of_v3)
    if (name == old)
      return "; that is pbrt-v3, and only pbrt-v4 files are supported: convert it by 'pbrt --upgrade old.pbrt > "
             "new.pbrt'";
  return otherwise;
}

/// The same for one of several kinds, with a suggestion.
template <class Names>
std::string upgrade_or_suggestion(std::string_view name, const Names& names) {
  return or_upgrade(name, suggestion(name, names));
}

}  // namespace alhazen::impl::pbrt
