#pragma once

// Host storage of a scene while it is built, one vector for each array of the list, and its move into one arena.

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "compile/compiled_scene.h"

namespace alhazen::impl {

inline constexpr size_t arena_alignment = 64;

template <class Real>
struct SceneArrays {
#define ALHAZEN_ARRAY(type, name) std::vector<type> name;
  ALHAZEN_SCENE_ARRAYS(ALHAZEN_ARRAY)
#undef ALHAZEN_ARRAY

  Bounds3<Real> bounds;                          ///< of all surfaces; known once the trees are built
  std::vector<TriangleOrigin> triangle_origins;  ///< by triangle, if they are kept; else empty

  /// A view of the arrays so far, for functions of the core; it is invalidated when arrays grow.
  SceneView<Real> view() const {
    SceneView<Real> view;
#define ALHAZEN_ARRAY(type, name) \
  view.name = name.data();        \
  view.name##_count = static_cast<uint32_t>(std::min<size_t>(name.size(), 0xffffffffu));
    ALHAZEN_SCENE_ARRAYS(ALHAZEN_ARRAY)
#undef ALHAZEN_ARRAY
    return view;
  }

  /// Size of the arena in bytes; each array is aligned.
  size_t arena_bytes() const {
    size_t bytes = 0;
    const auto add = [&](size_t size) { bytes += (size + arena_alignment - 1) / arena_alignment * arena_alignment; };
#define ALHAZEN_ARRAY(type, name) add(name.size() * sizeof(type));
    ALHAZEN_SCENE_ARRAYS(ALHAZEN_ARRAY)
#undef ALHAZEN_ARRAY
    return std::max(bytes, arena_alignment);
  }

  /// Moves the arrays into `scene`'s arena, one after the other; each is freed once it is copied.
  void move_into(CompiledScene<Real>& scene) {
    const size_t bytes = arena_bytes();
    scene.arena.reset(static_cast<std::byte*>(std::aligned_alloc(arena_alignment, bytes)));
    if (!scene.arena) throw std::bad_alloc();
    scene.statistics.bytes = bytes;
    scene.view.bounds = bounds;
    std::byte* next = scene.arena.get();
    const auto move = [&](auto& array, auto& pointer, uint32_t& count) {
      const size_t size = array.size() * sizeof(array[0]);
      const size_t padded = (size + arena_alignment - 1) / arena_alignment * arena_alignment;
      if (size > 0) std::memcpy(next, static_cast<const void*>(array.data()), size);
      std::memset(next + size, 0, padded - size);
      pointer = reinterpret_cast<std::remove_reference_t<decltype(pointer)>>(next);
      count = static_cast<uint32_t>(std::min<size_t>(array.size(), 0xffffffffu));
      next += padded;
      std::remove_reference_t<decltype(array)>().swap(array);
    };
#define ALHAZEN_ARRAY(type, name) move(name, scene.view.name, scene.view.name##_count);
    ALHAZEN_SCENE_ARRAYS(ALHAZEN_ARRAY)
#undef ALHAZEN_ARRAY
  }
};

/// Some of the arrays.
struct ArraySet {
#define ALHAZEN_ARRAY(type, name) bool name = false;
  ALHAZEN_SCENE_ARRAYS(ALHAZEN_ARRAY)
#undef ALHAZEN_ARRAY
};

/// Replaces these arrays of a compiled scene by those of `fresh`: in place where they have as many elements, else in
/// another arena to which all others are copied. Throws std::bad_alloc, and the scene is then unchanged.
template <class Real>
void replace_arrays(const SceneArrays<Real>& fresh, const ArraySet& replaced, CompiledScene<Real>& scene) {
  bool fits = true;
#define ALHAZEN_ARRAY(type, name) fits = fits && (!replaced.name || fresh.name.size() == scene.view.name##_count);
  ALHAZEN_SCENE_ARRAYS(ALHAZEN_ARRAY)
#undef ALHAZEN_ARRAY
  if (fits) {
#define ALHAZEN_ARRAY(type, name)                                                                              \
  if (replaced.name && !fresh.name.empty())                                                                    \
    std::memcpy(scene.arena.get() + (reinterpret_cast<const std::byte*>(scene.view.name) - scene.arena.get()), \
                static_cast<const void*>(fresh.name.data()), fresh.name.size() * sizeof(type));
    ALHAZEN_SCENE_ARRAYS(ALHAZEN_ARRAY)
#undef ALHAZEN_ARRAY
    return;
  }
  const auto padded = [](size_t size) { return (size + arena_alignment - 1) / arena_alignment * arena_alignment; };
  size_t bytes = 0;
#define ALHAZEN_ARRAY(type, name) \
  bytes += padded((replaced.name ? fresh.name.size() : scene.view.name##_count) * sizeof(type));
  ALHAZEN_SCENE_ARRAYS(ALHAZEN_ARRAY)
#undef ALHAZEN_ARRAY
  bytes = std::max(bytes, arena_alignment);
  std::unique_ptr<std::byte, FreeArena> arena(static_cast<std::byte*>(std::aligned_alloc(arena_alignment, bytes)));
  if (!arena) throw std::bad_alloc();
  std::byte* next = arena.get();
  const auto copy = [&](const void* source, size_t size) {
    std::byte* const place = next;
    if (size > 0) std::memcpy(place, source, size);
    std::memset(place + size, 0, padded(size) - size);
    next += padded(size);
    return place;
  };
#define ALHAZEN_ARRAY(type, name)                                                         \
  if (replaced.name) scene.view.name##_count = static_cast<uint32_t>(fresh.name.size());  \
  scene.view.name = reinterpret_cast<const type*>(                                        \
      copy(replaced.name ? static_cast<const void*>(fresh.name.data()) : scene.view.name, \
           static_cast<size_t>(scene.view.name##_count) * sizeof(type)));
  ALHAZEN_SCENE_ARRAYS(ALHAZEN_ARRAY)
#undef ALHAZEN_ARRAY
  scene.arena = std::move(arena);
  scene.statistics.bytes = bytes;
}

}  // namespace alhazen::impl
