#pragma once

// What the description calls a primitive that was hit (queries/primitive_origins.h), found without branches.

#include "core/shapes/shape_records.h"
#include "queries/primitive_origins.h"

namespace ALHAZEN_CORE {

/// What stands for a miss: all that follows from it is what the caller gets for one, but for t.
template <class Real>
inline constexpr Hit<Real> missing_hit{infinity<Real>, 0, 0, PrimitiveId(), no_instance};

class HitRows {
 public:
  explicit HitRows(const PrimitiveOrigins& origins) : rows_(origins.rows.data()) {
    for (uint32_t kind = 0; kind < kinds; ++kind) first_[kind] = origins.first_row[kind];
    // The missing primitive has the last kind and the last index, and row 0.
    first_[kinds - 1] = 0u - PrimitiveId().index();
  }

  template <class Real>
  ALHAZEN_INLINE const PrimitiveOrigin& of(const Hit<Real>& hit) const {
    return rows_[first_[static_cast<uint32_t>(hit.primitive.kind())] + hit.primitive.index()];
  }

 private:
  static constexpr uint32_t kinds = sizeof(PrimitiveOrigins::first_row) / sizeof(uint32_t);
  static_assert(primitive_kinds < kinds);

  const PrimitiveOrigin* rows_;
  uint32_t first_[kinds];
};

/// The weights of the second and third vertex of a triangle, in the order of the description.
template <class Real>
ALHAZEN_INLINE Vec2<Real> described_weights(const Hit<Real>& hit, uint32_t turn) {
  if (ALHAZEN_UNLIKELY(turn != 0)) {
    const Real b0 = 1 - hit.b1 - hit.b2;
    return turn == 1 ? Vec2<Real>{b0, hit.b1} : Vec2<Real>{hit.b2, b0};
  }
  return {hit.b1, hit.b2};
}

}  // namespace ALHAZEN_CORE
