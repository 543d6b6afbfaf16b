#pragma once

// The kinds of texture nodes. Each is defined in a file of kinds/: the number of its inputs, what it is evaluated over,
// the numbers that it stores, and its value at a point.

#include <cstdint>

#include "core/textures/kinds/arithmetic.h"
#include "core/textures/kinds/cellular.h"
#include "core/textures/kinds/checkerboard.h"
#include "core/textures/kinds/constant.h"
#include "core/textures/kinds/coordinates.h"
#include "core/textures/kinds/direction_mix.h"
#include "core/textures/kinds/dots.h"
#include "core/textures/kinds/image.h"
#include "core/textures/kinds/marble.h"
#include "core/textures/kinds/octave_noise.h"
#include "core/textures/kinds/vertex_colour.h"
#include "core/textures/kinds/windy.h"

namespace ALHAZEN_CORE {

/// Lists every kind of texture once, as KIND(name, Name). The enumeration, evaluation and compilation expand from it.
#define ALHAZEN_TEXTURES(KIND)      \
  KIND(constant, Constant)          \
  KIND(checkerboard, Checkerboard)  \
  KIND(image, Image)                \
  KIND(fbm, Fbm)                    \
  KIND(wrinkled, Wrinkled)          \
  KIND(marble, Marble)              \
  KIND(scale, Scale)                \
  KIND(mix, Mix)                    \
  KIND(channel, Channel)            \
  KIND(vertex_colour, VertexColour) \
  KIND(vertex_alpha, VertexAlpha)   \
  KIND(coordinates, Coordinates)    \
  KIND(dots, Dots)                  \
  KIND(windy, Windy)                \
  KIND(direction_mix, DirectionMix) \
  KIND(threshold, Threshold)        \
  KIND(cellular, Cellular)

enum class TextureKind : uint32_t {
#define ALHAZEN_KIND(name, Name) name,
  ALHAZEN_TEXTURES(ALHAZEN_KIND)
#undef ALHAZEN_KIND
};

ALHAZEN_HD constexpr uint32_t texture_input_count(TextureKind kind) {
  switch (kind) {
#define ALHAZEN_CASE(name, Name) \
  case TextureKind::name:        \
    return Name##Texture::input_count;
    ALHAZEN_TEXTURES(ALHAZEN_CASE)
#undef ALHAZEN_CASE
  }
  return 0;
}

constexpr TextureDomain texture_domain(TextureKind kind) {
  switch (kind) {
#define ALHAZEN_CASE(name, Name) \
  case TextureKind::name:        \
    return Name##Texture::domain;
    ALHAZEN_TEXTURES(ALHAZEN_CASE)
#undef ALHAZEN_CASE
  }
  return TextureDomain::none;
}

}  // namespace ALHAZEN_CORE
