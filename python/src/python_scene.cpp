#include "python_scene.h"

#include "alhazen/error.h"

namespace alhazen::python {

const alhazen::Scene& PythonScene::read() const {
  if (is_changing_) throw Error("another thread is changing the scene: wait until it has finished");
  return scene_;
}

alhazen::Scene& PythonScene::change() {
  read();
  if (readers_ > 0) throw Error("the scene is being rendered: wait until that has ended, or change a copy of it");
  ++changes_;
  return scene_;
}

SceneReading::SceneReading(const PythonScene& scene) : scene_(scene.shared_from_this()) {
  scene.read();
  ++scene.readers_;
}

SceneReading::~SceneReading() { --scene_->readers_; }

SceneChange::SceneChange(PythonScene& scene) : scene_(scene.shared_from_this()) {
  scene.change();
  scene.is_changing_ = true;
}

SceneChange::~SceneChange() { scene_->is_changing_ = false; }

}  // namespace alhazen::python
