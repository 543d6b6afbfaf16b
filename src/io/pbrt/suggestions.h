#pragma once

// Suggestions for misspelt names, and for names of pbrt-v3.

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace alhazen::pbrt {

/// Levenshtein distance, computed row by row.
inline size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, diagonal + 1});
    }
  }
  return row[b.size()];
}

/// `; did you mean "x"?` if one of `names` is close to `word`, else nothing.
template <class Names>
std::string suggestion(std::string_view word, const Names& names) {
  std::string_view best;
  size_t best_distance = word.size() < 4 ? 2 : 3;
  if (word.size() > 64) return {};
  for (const auto& candidate : names) {
    const std::string_view name = candidate;
    if (name.size() >= word.size() + best_distance || word.size() >= name.size() + best_distance) continue;
    const size_t distance = edit_distance(word, name);
    if (distance < best_distance && distance < word.size()) {
      best = name;
      best_distance = distance;
    }
  }
  return best.empty() ? std::string() : "; did you mean \"" + std::string(best) + "\"?";
}

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

}  // namespace alhazen::pbrt
