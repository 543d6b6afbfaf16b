#include "api/slots.h"

#include <cmath>

namespace alhazen::impl {

namespace {

/// The value of a slot that holds a file's or its own constant.
std::optional<Vec3d> constant_in(const SceneState& state, uint32_t slot) {
  if (slot >= state.description.textures.size()) return {};
  if (state.constant_uses.at(slot) == ConstantUse::texture) return {};
  return state.description.textures[slot].value;
}

void check_range(std::string_view name, double value, ValueRange range) {
  if (range == ValueRange::any) finite_number(name, value);
  if (range == ValueRange::not_negative) non_negative_number(name, value);
  if (range == ValueRange::unit) number_between(name, value, 0, 1);
}

}  // namespace

void SlotReader::colour(std::string_view, ColourInput& input, uint32_t slot, const Colour& absent, ValueRange) const {
  if (slot == no_index)
    input = absent;
  else if (const std::optional<Vec3d> constant = constant_in(state_, slot))
    input = public_colour(*constant);
  else
    input = handle_of<TextureId>(slot, state_.textures);
}

void SlotReader::number(std::string_view, NumberInput& input, uint32_t slot, double absent, ValueRange) const {
  if (slot == no_index)
    input = absent;
  else if (const std::optional<Vec3d> constant = constant_in(state_, slot))
    input = constant->x;
  else
    input = handle_of<TextureId>(slot, state_.textures);
}

void SlotReader::optional_colour(std::string_view name, std::optional<ColourInput>& input, uint32_t slot,
                                 ValueRange range) const {
  input.reset();
  if (slot != no_index) colour(name, input.emplace(0.0), slot, 0.0, range);
}

void SlotReader::texture(std::string_view, TextureId& input, uint32_t slot) const {
  input = handle_of<TextureId>(slot, state_.textures);
}

void SlotReader::material(std::string_view, MaterialId& input, uint32_t index) const {
  input = handle_of<MaterialId>(index, state_.materials);
}

void SlotWriter::colour(std::string_view name, const ColourInput& input, uint32_t& slot, const Colour& absent,
                        ValueRange range) {
  ColourInput present = 0.0;
  reader_.colour(name, present, slot, absent, range);
  if (present == input) return;
  if (input.is_texture()) return given_texture(name, input.texture(), slot);
  const Vec3d value = vector_of(input.colour());
  for (int i = 0; i < 3; ++i) check_range(name, value[i], range);
  if (!writes_) return;
  if (input.colour() == absent) return release(slot);
  put_constant(slot, value);
}

void SlotWriter::number(std::string_view name, const NumberInput& input, uint32_t& slot, double absent,
                        ValueRange range) {
  NumberInput present = 0.0;
  reader_.number(name, present, slot, absent, range);
  if (present == input) return;
  if (input.is_texture()) return given_texture(name, input.texture(), slot);
  check_range(name, input.number(), range);
  if (!writes_) return;
  if (input.number() == absent) return release(slot);
  put_constant(slot, splat(input.number()));
}

void SlotWriter::optional_colour(std::string_view name, const std::optional<ColourInput>& input, uint32_t& slot,
                                 ValueRange range) {
  std::optional<ColourInput> present;
  reader_.optional_colour(name, present, slot, range);
  if (present == input) return;
  if (!input) {
    if (writes_) release(slot);
    return;
  }
  if (input->is_texture()) return given_texture(name, input->texture(), slot);
  const Vec3d value = vector_of(input->colour());
  for (int i = 0; i < 3; ++i) check_range(name, value[i], range);
  if (writes_) put_constant(slot, value);
}

void SlotWriter::given_texture(std::string_view name, TextureId input, uint32_t& slot) {
  index_of(name, input, state_);
  texture(name, input, slot);
}

void SlotWriter::texture(std::string_view name, TextureId input, uint32_t& slot) {
  const uint32_t index = input ? index_of(name, input, state_) : no_index;
  if (!writes_ || index == slot) return;
  release(slot);
  slot = index;
}

void SlotWriter::material(std::string_view name, MaterialId input, uint32_t& index) {
  const uint32_t given = index_of(name, input, state_);
  if (writes_) index = given;
}

void SlotWriter::put_constant(uint32_t& slot, const Vec3d& value) {
  std::vector<Texture>& textures = state_.description.textures;
  if (slot == no_index || state_.constant_uses.at(slot) != ConstantUse::owned) {
    if (state_.unused_constants.empty()) {
      const auto index = static_cast<uint32_t>(textures.size());
      state_.constant_uses.reserve(textures.size() + 1);
      state_.unused_constants.reserve(textures.size() + 1);  // release() never allocates
      textures.emplace_back();
      state_.constant_uses.push_back(ConstantUse::owned);
      state_.textures.add(index, state_.id);
      slot = index;
    } else {
      slot = state_.unused_constants.back();
      state_.unused_constants.pop_back();
      state_.constant_uses[slot] = ConstantUse::owned;
    }
  }
  textures[slot].value = value;
}

void SlotWriter::release(uint32_t& slot) {
  if (slot != no_index && state_.constant_uses.at(slot) == ConstantUse::owned) {
    state_.constant_uses[slot] = ConstantUse::unused;
    state_.description.textures[slot] = {};
    state_.unused_constants.push_back(slot);
  }
  slot = no_index;
}

}  // namespace alhazen::impl
