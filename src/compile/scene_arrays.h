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

/// An array whose first elements are replaced by others, which may be more or fewer.
struct ArrayFront {
  bool is_replaced = false;
  const void* elements = nullptr;
  size_t count = 0;
  size_t old_count = 0;  ///< number of elements that are replaced
};

struct ArrayFronts {
#define ALHAZEN_ARRAY(type, name) ArrayFront name;
  ALHAZEN_SCENE_ARRAYS(ALHAZEN_ARRAY)
#undef ALHAZEN_ARRAY
};

/// Replaces an array as a whole.
template <class Type>
ArrayFront whole_array(const std::vector<Type>& fresh, uint32_t old_count) {
  return {true, fresh.data(), fresh.size(), old_count};
}

/// Replaces the fronts of arrays of a compiled scene: in place if they fit, else in another arena to which all others
/// are copied. There, an array that has grown or shrunk has room for an eighth more, so that the next change fits.
/// Throws std::bad_alloc, and the scene is then unchanged.
template <class Real>
void replace_fronts(const ArrayFronts& fronts, CompiledScene<Real>& scene) {
  struct Place {
    std::byte* start;
    size_t room;         // to the next array
    size_t front, tail;  // bytes, after the change
    size_t old_front;
    const ArrayFront* change;
  };
  std::byte* const arena = scene.arena.get();
  const auto padded = [](size_t size) { return (size + arena_alignment - 1) / arena_alignment * arena_alignment; };
  std::vector<Place> places;
#define ALHAZEN_ARRAY(type, name)                                                                               \
  {                                                                                                             \
    const ArrayFront& f = fronts.name;                                                                          \
    const size_t tail = f.is_replaced ? (scene.view.name##_count - f.old_count) * sizeof(type) : 0;             \
    places.push_back({arena + (reinterpret_cast<const std::byte*>(scene.view.name) - arena), 0,                 \
                      f.count * sizeof(type), tail, f.old_count * sizeof(type), f.is_replaced ? &f : nullptr}); \
    if (f.is_replaced)                                                                                          \
      scene.view.name##_count = static_cast<uint32_t>(scene.view.name##_count - f.old_count + f.count);         \
  }
  const SceneView<Real> before = scene.view;
  ALHAZEN_SCENE_ARRAYS(ALHAZEN_ARRAY)
#undef ALHAZEN_ARRAY
  bool fits = true;
  for (size_t i = 0; i < places.size(); ++i) {
    Place& place = places[i];
    const std::byte* const next = i + 1 < places.size() ? places[i + 1].start : arena + scene.statistics.bytes;
    place.room = static_cast<size_t>(next - place.start);
    fits = fits && (!place.change || place.front + place.tail <= place.room);
  }
  ++scene.generation;
  const auto put_front = [](std::byte* to, const Place& place) {
    if (place.front > 0) std::memcpy(to, place.change->elements, place.front);
  };
  if (fits) {
    for (const Place& place : places) {
      if (!place.change) continue;
      if (place.front != place.old_front && place.tail > 0)
        std::memmove(place.start + place.front, place.start + place.old_front, place.tail);
      put_front(place.start, place);
    }
    return;
  }
  size_t bytes = 0;
  std::vector<size_t> rooms;
  for (const Place& place : places) {
    const size_t size = place.front + place.tail;
    const bool has_other_size = place.change && place.front != place.old_front;
    rooms.push_back(place.change ? padded(has_other_size ? size + size / 8 : size) : place.room);
    bytes += rooms.back();
  }
  bytes = std::max(bytes, arena_alignment);
  std::unique_ptr<std::byte, FreeArena> other(static_cast<std::byte*>(std::aligned_alloc(arena_alignment, bytes)));
  if (!other) {
    scene.view = before;
    throw std::bad_alloc();
  }
  std::byte* next = other.get();
  for (size_t i = 0; i < places.size(); ++i) {
    Place& place = places[i];
    if (place.change) {
      put_front(next, place);
      if (place.tail > 0) std::memcpy(next + place.front, place.start + place.old_front, place.tail);
      std::memset(next + place.front + place.tail, 0, rooms[i] - place.front - place.tail);
    } else if (place.room > 0) {
      std::memcpy(next, place.start, place.room);
    }
    place.start = next;
    next += rooms[i];
  }
  const Place* place = places.data();
#define ALHAZEN_ARRAY(type, name) scene.view.name = reinterpret_cast<const type*>((place++)->start);
  ALHAZEN_SCENE_ARRAYS(ALHAZEN_ARRAY)
#undef ALHAZEN_ARRAY
  scene.arena = std::move(other);
  scene.statistics.bytes = bytes;
}

}  // namespace alhazen::impl
