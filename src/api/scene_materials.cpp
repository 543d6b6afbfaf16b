// The images, textures and materials of a public scene.

#include <utility>

#include "alhazen/scene.h"
#include "api/caller_errors.h"
#include "api/image_texels.h"
#include "api/material_slots.h"
#include "api/parts.h"
#include "api/texture_slots.h"
#include "images/read_scalar_texture.h"
#include "images/read_texture.h"

namespace ALHAZEN_NAMESPACE {

namespace {

ImageId add_image(impl::SceneState& s, impl::ImageTexels&& texels) {
  const auto index = static_cast<uint32_t>(s.description.images.size());
  s.description.images.push_back(std::move(texels));
  s.images.add(index, s.id);
  ++s.revisions.images;
  return impl::handle_of<ImageId>(index, s.images);
}

impl::TextureEncoding texture_encoding(const std::optional<Encoding>& encoding) {
  if (!encoding) return impl::TextureEncoding::automatic;
  return impl::same_kind<Encoding>("encoding", *encoding, 2) == Encoding::srgb ? impl::TextureEncoding::srgb
                                                                               : impl::TextureEncoding::data;
}

/// Throws if `part` is, or mixes, the material `whole`.
void refuse_mix_within_itself(const impl::Scene& scene, uint32_t part, uint32_t whole) {
  std::vector<bool> is_seen(scene.materials.size());
  std::vector<uint32_t> open{part};
  while (!open.empty()) {
    const uint32_t index = open.back();
    open.pop_back();
    if (index == whole) impl::refuse_argument("materials", "would make the mix contain itself");
    if (index >= is_seen.size() || is_seen[index]) continue;
    is_seen[index] = true;
    const impl::Material& material = scene.materials[index];
    if (material.kind == impl::MaterialKind::mix) open.insert(open.end(), material.mixed.begin(), material.mixed.end());
  }
}

}  // namespace

ImageId Scene::add(const Pixels& pixels) {
  return impl::for_caller([&] { return add_image(state(), impl::image_of_pixels(pixels)); });
}

ImageId Scene::load_image(const std::string& file, std::optional<Encoding> encoding) {
  const impl::TextureEncoding as = texture_encoding(encoding);
  return impl::for_caller([&] { return add_image(state(), impl::read_texture({file}, as)); });
}

ImageId Scene::load_scalar_image(const std::string& file, std::optional<Encoding> encoding) {
  const impl::TextureEncoding as = texture_encoding(encoding);
  return impl::for_caller([&] { return add_image(state(), impl::read_scalar_texture({file}, as).texels); });
}

Pixels Scene::image(ImageId image) const {
  return impl::pixels_of(state().description.images[impl::index_of("image", image, state())]);
}

void Scene::set_image(ImageId image, const Pixels& pixels) {
  const uint32_t index = impl::index_of("image", image, state());
  state().description.images[index] = impl::for_caller([&] { return impl::image_of_pixels(pixels); });
  ++state().revisions.images;
}

TextureId Scene::add(const Texture& texture) {
  impl::SceneState& s = state();
  impl::Texture made;
  // Constants for its inputs may come before it.
  impl::write_texture(s, texture, impl::no_index, made);
  const auto index = static_cast<uint32_t>(s.description.textures.size());
  s.constant_uses.reserve(index + size_t{1});
  s.unused_constants.reserve(index + size_t{1});
  s.description.textures.push_back(std::move(made));
  s.constant_uses.push_back(impl::ConstantUse::texture);
  s.textures.add(index, s.id);
  ++s.revisions.materials;
  return impl::handle_of<TextureId>(index, s.textures);
}

Texture Scene::texture(TextureId texture) const {
  return impl::public_texture(state(), state().description.textures[impl::index_of("texture", texture, state())]);
}

void Scene::set(TextureId id, const Texture& texture) {
  impl::SceneState& s = state();
  const uint32_t index = impl::index_of("texture", id, s);
  impl::write_texture(s, texture, index, s.description.textures[index]);
  s.constant_uses[index] = impl::ConstantUse::texture;
  ++s.revisions.materials;
}

MaterialId Scene::add(const Material& material) {
  impl::SceneState& s = state();
  impl::Material made;
  impl::write_material(s, material, made);
  const auto index = static_cast<uint32_t>(s.description.materials.size());
  s.description.materials.push_back(std::move(made));
  s.materials.add(index, s.id);
  ++s.revisions.materials;
  return impl::handle_of<MaterialId>(index, s.materials);
}

Material Scene::material(MaterialId material) const {
  return impl::public_material(state(), state().description.materials[impl::index_of("material", material, state())]);
}

void Scene::set(MaterialId id, const Material& material) {
  impl::SceneState& s = state();
  const uint32_t index = impl::index_of("material", id, s);
  if (const auto* mix = std::get_if<Mix>(&material.bsdf))
    for (const MaterialId part : mix->materials)
      refuse_mix_within_itself(s.description, impl::index_of("materials", part, s), index);
  impl::write_material(s, material, s.description.materials[index]);
  ++s.revisions.materials;
}

}  // namespace ALHAZEN_NAMESPACE
