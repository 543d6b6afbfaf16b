// What pages change of a view, and what they ask of its scene.

#include <algorithm>
#include <utility>
#include <variant>

#include "alhazen/error.h"
#include "view/overloaded.h"
#include "view/view_session.h"

namespace alhazen::impl {

template <class Change>
void ViewSession::apply_for(ViewerId viewer, const Change& change) {
  try {
    change();
  } catch (const Cancelled&) {
    throw;
  } catch (...) {
    viewers_.tell(viewer, error_message(text_of_error(), false));
  }
}

void ViewSession::apply(Mail& mail) {
  const std::lock_guard lock(scene_mutex_);
  const bool has_new_view = mail.camera || mail.size || mail.environment || !mail.materials.empty();
  if (mail.camera) apply_for(mail.camera->viewer, [&] { move_camera(*mail.camera); });
  if (mail.size) {
    renderer_->set_size(mail.size->message.width, mail.size->message.height);
    refused_layers_.clear();
  }
  if (mail.samples) renderer_->set_samples(mail.samples->message.samples);
  if (mail.environment) renderer_->set_environment(mail.environment->message);
  for (const auto& [index, from] : mail.materials) apply_for(from.viewer, [&] { change_material(from.message); });
  if (mail.size || mail.samples || mail.environment) tell_scene();
  if (has_new_view) {
    if (!mail.camera) origin_.reset();
    begin_view();
  } else if (mail.samples) {
    // What is there may have more samples than there are to be.
    const std::shared_ptr<const Picture> shown = viewers_.shown("color");
    if (shown && shown->samples > static_cast<double>(mail.samples->message.samples))
      begin_view();
    else
      begin_image();
  } else if (mail.layers || mail.denoise) {
    begin_image();
  }
}

void ViewSession::change_material(const MaterialMessage& message) {
  Scene& scene = renderer_->scene();
  const std::vector<MaterialId> materials = scene.materials();
  if (message.material >= materials.size())
    throw InputError("material: there are " + std::to_string(materials.size()) + " materials, numbered from 0");
  const MaterialId material = materials[message.material];
  changes_.remember(scene, material);
  set_material_fields(scene, material, message.values);
  const std::string changes = changes_message(changes_.lines(scene));
  const std::lock_guard lock(mutex_);
  changes_text_ = changes;
  viewers_.tell_everyone(changes);
}

void ViewSession::pick(ViewerId viewer, const PickMessage& message) try {
  apply_for(viewer, [&] {
    const std::lock_guard lock(scene_mutex_);
    if (!renderer_) throw InputError("pick: the scene is being read");
    const Scene& scene = renderer_->scene();
    PickedText picked;
    picked.id = message.id;
    picked.point = picker_.pick(scene, renderer_->width(), renderer_->height(), message.x, message.y,
                                [this](const Progress&) { return !mailbox_.is_ending(); });
    if (picked.point && picked.point->material) {
      const std::vector<MaterialId> materials = scene.materials();
      const MaterialId id = picked.point->material;
      picked.material_index =
          static_cast<size_t>(std::find(materials.begin(), materials.end(), id) - materials.begin());
      const Material material = scene.material(id);
      picked.material_name = scene.name(id);
      picked.kind = material_kind(material);
      picked.fields = material_fields(material);
    }
    viewers_.tell(viewer, picked_message(picked));
  });
} catch (const Cancelled&) {  // the session ends
}

Camera ViewSession::file_camera(size_t index) {
  LoadOptions load = options_.load;
  load.camera = std::to_string(index);
  change_status([](StatusText& status) { status.activity = "reading"; });
  return Scene::load(options_.scene, load, [this](const Progress&) { return !mailbox_.is_ending(); }).camera();
}

void ViewSession::move_camera(const From<CameraRequest>& request) {
  origin_.reset();
  placed_.reset();
  std::visit(Overloaded{
                 [&](const CameraMessage& m) {
                   renderer_->set_camera(placed_camera(renderer_->first_camera(), m.camera));
                   origin_ = ViewOrigin{request.viewer, m.id};
                   placed_ = m.camera;
                 },
                 [&](const ResetMessage&) { renderer_->set_camera(renderer_->first_camera()); },
                 [&](const SelectCameraMessage& m) { renderer_->set_camera(file_camera(m.camera)); },
             },
             request.message);
  if (!std::holds_alternative<CameraMessage>(request.message)) tell_camera(0);
}

}  // namespace alhazen::impl
