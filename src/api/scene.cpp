// A public scene as a whole: made, copied, read, and what is in it.

#include "alhazen/scene.h"

#include <utility>

#include "api/building.h"
#include "api/parts.h"
#include "api/scene_state.h"
#include "io/read_scene.h"
#include "pipeline/load_scene.h"
#include "scene/default_view.h"

namespace ALHAZEN_NAMESPACE {

Scene::Scene() : state_(std::make_unique<impl::SceneState>()) {}
Scene::Scene(std::unique_ptr<impl::SceneState> state) : state_(std::move(state)) {}
Scene::~Scene() = default;
Scene::Scene(const Scene& other)
    : state_(impl::for_caller([&] { return std::make_unique<impl::SceneState>(other.state()); })) {}
Scene::Scene(Scene&& other) noexcept = default;
Scene& Scene::operator=(Scene&& other) noexcept = default;

Scene& Scene::operator=(const Scene& other) {
  if (this != &other) *this = Scene(other);
  return *this;
}

const impl::SceneState& Scene::state() const {
  if (!state_) throw InputError("the scene was moved from: assign another to it first");
  return *state_;
}

impl::SceneState& Scene::state() { return const_cast<impl::SceneState&>(std::as_const(*this).state()); }

Scene Scene::load(const std::string& file, const LoadOptions& options, const ProgressFunction& progress) {
  Settings settings;
  settings.camera = options.camera;
  settings.variant = options.variant;
  settings.animation = options.animation;
  settings.animation_time = options.time;
  settings.shutter = options.shutter;
  settings.frames_per_second = options.frames_per_second;
  settings.definitions = options.definitions;
  settings.search_paths = options.search_paths;
  settings.confine = options.confine;
  settings.strict = options.strict;
  impl::Diagnostics diagnostics;
  impl::Listener listener(progress);
  listener.watch(diagnostics.activity());
  return listener.for_caller([&] {
    impl::ReadOptions choice = impl::read_options(settings);
    choice.record = std::make_shared<impl::InputRecord>();
    diagnostics.activity().begin("reading the scene");
    impl::Scene scene = impl::read_scene(file, choice, diagnostics);
    return Scene(std::make_unique<impl::SceneState>(std::move(scene), diagnostics, choice.record));
  });
}

std::vector<Warning> Scene::warnings() const {
  std::vector<Warning> list;
  for (const impl::Diagnostics::Warning& warning : state().warnings) list.push_back(warning.to_public());
  return list;
}

std::string Scene::file() const { return state().is_read ? state().description.name : std::string(); }

Box Scene::bounds() const {
  const impl::Scene& scene = state().description;
  impl::Bounds3<double> box;
  impl::for_each_placed_shape(scene, [&](const impl::Shape& shape, const impl::Transform& world_from_object) {
    impl::for_each_point(scene, shape, world_from_object, [&](const impl::Vec3d& p) { box.extend(p); });
  });
  return {impl::public_vector(box.low), impl::public_vector(box.high)};
}

namespace {

template <class Id>
std::vector<Id> handles_up_to(size_t count, const impl::PartOwners& owners, size_t first = 0) {
  std::vector<Id> handles;
  for (size_t i = first; i < count; ++i) handles.push_back(impl::handle_of<Id>(static_cast<uint32_t>(i), owners));
  return handles;
}

template <class Id>
std::vector<Id> handles_with_place(const std::vector<uint32_t>& places, const impl::PartOwners& owners) {
  std::vector<Id> handles;
  for (uint32_t i = 0; i < places.size(); ++i)
    if (places[i] != impl::no_index) handles.push_back(impl::handle_of<Id>(i, owners));
  return handles;
}

}  // namespace

std::vector<MeshId> Scene::meshes() const {
  return handles_up_to<MeshId>(state().description.meshes.size(), state().meshes);
}

std::vector<ImageId> Scene::images() const {
  return handles_up_to<ImageId>(state().description.images.size(), state().images);
}

std::vector<TextureId> Scene::textures() const {
  std::vector<TextureId> handles;
  for (uint32_t i = 0; i < state().constant_uses.size(); ++i)
    if (state().constant_uses[i] == impl::ConstantUse::texture)
      handles.push_back(impl::handle_of<TextureId>(i, state().textures));
  return handles;
}

std::vector<MaterialId> Scene::materials() const {
  return handles_up_to<MaterialId>(state().description.materials.size(), state().materials);
}

std::vector<ShapeId> Scene::shapes() const {
  std::vector<std::vector<ShapeId>> by_group(state().description.groups.size());
  for (uint32_t i = 0; i < state().shape_places.size(); ++i)
    if (const uint32_t group = state().shape_places[i].group; group != impl::no_index)
      by_group[group].push_back(impl::handle_of<ShapeId>(i, state().shapes));
  std::vector<ShapeId> handles;
  for (const std::vector<ShapeId>& group : by_group) handles.insert(handles.end(), group.begin(), group.end());
  return handles;
}

std::vector<ShapeId> Scene::shapes(GroupId group) const {
  const uint32_t index = group ? impl::index_of("group", group, state()) : 0;
  std::vector<ShapeId> handles(state().description.groups[index].shapes.size());
  for (uint32_t i = 0; i < state().shape_places.size(); ++i)
    if (const impl::ShapePlace place = state().shape_places[i]; place.group == index)
      handles[place.index] = impl::handle_of<ShapeId>(i, state().shapes);
  return handles;
}

std::vector<GroupId> Scene::groups() const {
  return handles_up_to<GroupId>(state().description.groups.size(), state().groups, 1);
}

std::vector<InstanceId> Scene::instances() const {
  return handles_with_place<InstanceId>(state().instance_places, state().instances);
}

std::vector<LightId> Scene::lights() const { return handles_with_place<LightId>(state().light_places, state().lights); }

}  // namespace ALHAZEN_NAMESPACE
