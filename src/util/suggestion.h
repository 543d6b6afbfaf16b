#pragma once

// Suggestions for misspelt names.

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace alhazen::impl {

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

}  // namespace alhazen::impl
