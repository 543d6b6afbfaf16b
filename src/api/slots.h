#pragma once

// Inputs of materials and textures: a public value or texture on one side, and an index of a texture of the description
// on the other. What a part's members are is written once, as `describe(io, public, internal)`, and goes both ways:
// SlotReader fills the public struct; SlotWriter, which runs twice, first checks what differs, then writes it. So what
// is set as it was read stays as the file says.

#include <optional>
#include <string>
#include <string_view>

#include "alhazen/textures.h"
#include "api/parts.h"

namespace alhazen::impl {

/// What values an input may have.
enum class ValueRange { any, not_negative, unit };

class SlotReader {
 public:
  explicit SlotReader(const SceneState& state) : state_(state) {}

  void colour(std::string_view, ColourInput& input, uint32_t slot, const Colour& absent, ValueRange) const;
  void number(std::string_view, NumberInput& input, uint32_t slot, double absent, ValueRange) const;
  void optional_colour(std::string_view, std::optional<ColourInput>& input, uint32_t slot, ValueRange) const;
  void texture(std::string_view, TextureId& input, uint32_t slot) const;
  void material(std::string_view, MaterialId& input, uint32_t index) const;
  /// A member that is no input, converted by `to_public`; `to_internal` checks and converts it.
  template <class Public, class Internal, class ToPublic, class ToInternal>
  void value(Public& outside, const Internal& inside, const ToPublic& to_public, const ToInternal&) const {
    outside = to_public(inside);
  }

 private:
  const SceneState& state_;
};

class SlotWriter {
 public:
  SlotWriter(SceneState& state, bool writes) : state_(state), reader_(state), writes_(writes) {}

  void colour(std::string_view name, const ColourInput& input, uint32_t& slot, const Colour& absent, ValueRange range);
  void number(std::string_view name, const NumberInput& input, uint32_t& slot, double absent, ValueRange range);
  void optional_colour(std::string_view name, const std::optional<ColourInput>& input, uint32_t& slot,
                       ValueRange range);
  /// A handle that names nothing says that there is no texture.
  void texture(std::string_view name, TextureId input, uint32_t& slot);
  /// A handle that names nothing is refused.
  void given_texture(std::string_view name, TextureId input, uint32_t& slot);
  void material(std::string_view name, MaterialId input, uint32_t& index);
  template <class Public, class Internal, class ToPublic, class ToInternal>
  void value(const Public& outside, Internal& inside, const ToPublic& to_public, const ToInternal& to_internal) {
    if (to_public(inside) == outside) return;
    Internal converted = to_internal(outside);
    if (writes_) inside = std::move(converted);
  }

  /// A constant that only this slot has, where it does not have one yet.
  void put_constant(uint32_t& slot, const Vec3d& value);
  /// Gives back the constant that only this slot has.
  void release(uint32_t& slot);
  bool writes() const { return writes_; }
  const SceneState& state() const { return state_; }

 private:
  SceneState& state_;
  SlotReader reader_;
  bool writes_;
};

}  // namespace alhazen::impl
