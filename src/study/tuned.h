#pragma once

// What `alhazen study tune --store` found, kept in a file of the user's, and used by `--backend auto`. It says how fast
// a picture comes about, never what is in it, so whatever is wrong with the file is a warning and no more.

#include <optional>
#include <string>
#include <vector>

#include "render/settings.h"

namespace alhazen::study {

/// An entry is for a machine, a scene (or any), a precision and an integrator.
struct TunedEntry {
  std::string machine;  ///< machine_key()
  std::string scene;    ///< scene_key(), or any_scene
  std::string precision, integrator;
  std::string scene_name, version, date;  ///< for people
  double nanoseconds_per_sample = 0;
  Settings engine;  ///< backend, strategy, schedule, threads, block, chunk
};

inline constexpr const char* any_scene = "default";

/// $ALHAZEN_TUNED where that is set (empty: there is no file), else alhazen/tuned.json in $XDG_CONFIG_HOME or
/// ~/.config.
std::string tuned_path();
/// The processor and how many there are of it.
std::string machine_key();
/// A hash of the scene file as it lies there; what it includes is not looked at. Empty where it cannot be read.
std::string scene_key(const std::string& path);

/// The entries of the file; none where there is no file. Throws InputError where it cannot be understood.
std::vector<TunedEntry> read_tuned(const std::string& path);
/// Puts `entry` in the place of one for the same and writes the file. Throws InputError, RenderError.
void store_tuned(const std::string& path, const TunedEntry& entry);

/// As resolve_settings, by the stored engine where none was asked for and there is one.
RenderSettings resolve_with_tuned(const Settings& asked, const Scene& scene, const std::string& scene_path,
                                  Diagnostics& diagnostics);

}  // namespace alhazen::study
