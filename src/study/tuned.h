#pragma once

// The results of `alhazen study tune --store`, kept in a file of the user and used by `--backend auto`. They affect the
// speed of a render but never its image, so any problem with the file is only a warning.

#include <optional>
#include <string>
#include <vector>

#include "render/settings.h"

namespace alhazen::impl::study {

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

/// $ALHAZEN_TUNED if it is set (empty: no file), else alhazen/tuned.json in $XDG_CONFIG_HOME or ~/.config.
std::string tuned_path();
/// The model and number of processors.
std::string machine_key();
/// A hash of the scene file itself, without the files that it includes. Empty if it cannot be read.
std::string scene_key(const std::string& path);

/// The entries of the file; none if there is no file. Throws InputError if it is malformed.
std::vector<TunedEntry> read_tuned(const std::string& path);
/// Throws InputError if the file cannot be written: there is no location for it, its folder cannot be created, it is
/// damaged, or the user may not write it. Creates the folder.
void check_tuned_target(const std::string& path);
/// Adds `entry`, replacing one for the same key, and writes the file. Throws InputError, RenderError.
void store_tuned(const std::string& path, const TunedEntry& entry);

/// As resolve_settings, with the stored engine if the user requested none and there is one.
RenderSettings resolve_with_tuned(const Settings& asked, const Scene& scene, const std::string& scene_path,
                                  Diagnostics& diagnostics);

}  // namespace alhazen::impl::study
