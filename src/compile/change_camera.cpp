#include "compile/change_camera.h"

#include "compile/camera.h"
#include "compile/open_backs.h"

namespace alhazen::impl {

template <class Real>
void change_camera(Camera camera, const std::string& scene_name, int64_t width, int64_t height, int threads,
                   CompiledScene<Real>& scene) {
  if (!is_zero(scene.world_origin)) {
    Transform& start = camera.world_from_camera.start;
    start = Transform::translate(-scene.world_origin) * start;
  }
  scene.view.camera = camera_record<Real>(camera, scene_name, width, height);
  open_seen_backs(static_cast<uint32_t>(width), static_cast<uint32_t>(height), threads, scene);
}

template void change_camera(Camera, const std::string&, int64_t, int64_t, int, CompiledScene<float>&);
template void change_camera(Camera, const std::string&, int64_t, int64_t, int, CompiledScene<double>&);

}  // namespace alhazen::impl
