#pragma once

// The scene behind alhazen.Scene, and who may use it while the interpreter's lock (GIL) is released.

#include <cstdint>
#include <memory>
#include <utility>

#include "alhazen/scene.h"

namespace alhazen::python {

/// Bound as alhazen.Scene, held by shared_ptr: what Python has of its parts keeps it alive. All but `hold` and the
/// scene within need the GIL.
class PythonScene : public std::enable_shared_from_this<PythonScene> {
 public:
  PythonScene() = default;
  explicit PythonScene(alhazen::Scene&& scene) : scene_(std::move(scene)) {}

  /// Throws Error while another thread changes it.
  const alhazen::Scene& read() const;
  /// Throws Error while another thread reads or changes it.
  alhazen::Scene& change();

  /// How often `change` or SceneChange was used.
  uint64_t changes() const { return changes_; }
  /// What queries.cpp keeps for the scene.
  const std::shared_ptr<void>& kept_queries() const { return kept_queries_; }
  void keep_queries(std::shared_ptr<void> queries) const { kept_queries_ = std::move(queries); }

 private:
  friend class SceneReading;
  friend class SceneChange;
  alhazen::Scene scene_;
  mutable int readers_ = 0;
  bool is_changing_ = false;
  uint64_t changes_ = 0;
  mutable std::shared_ptr<void> kept_queries_;
};

/// Lets a thread read the scene without the GIL: as long as one exists, changes are refused. It is made and destroyed
/// with the GIL held:
///
///   const SceneReading reading(python_scene);
///   const Unlocked unlocked;
///   return alhazen::render(reading.scene(), settings);
class SceneReading {
 public:
  explicit SceneReading(const PythonScene& scene);
  ~SceneReading();
  SceneReading(const SceneReading&) = delete;
  SceneReading& operator=(const SceneReading&) = delete;
  const alhazen::Scene& scene() const { return scene_->scene_; }

 private:
  std::shared_ptr<const PythonScene> scene_;
};

/// Likewise lets it change the scene: nobody else reads or changes it.
class SceneChange {
 public:
  explicit SceneChange(PythonScene& scene);
  ~SceneChange();
  SceneChange(const SceneChange&) = delete;
  SceneChange& operator=(const SceneChange&) = delete;
  alhazen::Scene& scene() const { return scene_->scene_; }

 private:
  std::shared_ptr<PythonScene> scene_;
};

}  // namespace alhazen::python
