#pragma once

// Records in structure-of-arrays form: an array for each number that a record consists of. The arrays, and reading and
// writing of a record, are generated from the record's list of members (core/math/field_list.h).
//
//   SoA<Ray<float>, 64> rays;                          // 64 rays
//   rays.set(i, ray);
//   const float time = rays[i].time;                   // reads one number: the compiler drops what is not used
//   element<&Ray<float>::time>(rays, i) = 0;           // writes one number
//   SoA<Ray<float>, 64, FieldList<&Ray<float>::origin>> origins;  // the other members keep their defaults

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "core/math/field_list.h"
#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// Rounds `count` up to the row at which loops over an SoA end, so that no remainder is left for narrower instructions.
/// An SoA has a multiple of 16 rows; results in rows beyond `count` are unused.
constexpr uint32_t whole_rows(uint32_t count) { return (count + 15) & ~uint32_t{15}; }

/// Arrays inside the SoA, for loops that compilers vectorize. Booleans are as wide as the numbers beside them.
template <uint32_t count>
struct InlineStorage {
  static_assert(whole_rows(count) == count);

  template <class Value>
  struct Array {
    using Element = std::conditional_t<std::is_same_v<Value, bool>, uint32_t, Value>;
    Element elements[count]{};

    ALHAZEN_HD ALHAZEN_INLINE const Element& operator[](uint32_t i) const { return elements[i]; }
    ALHAZEN_HD ALHAZEN_INLINE Element& operator[](uint32_t i) { return elements[i]; }
  };
};

/// Arrays elsewhere, such as in the memory of a device. Copies refer to the same arrays, and those of constants can be
/// written.
struct PointerStorage {
  template <class Value>
  struct Array {
    using Element = Value;
    Element* elements = nullptr;

    ALHAZEN_HD ALHAZEN_INLINE Element& operator[](uint32_t i) const { return elements[i]; }
  };
};

/// Stands for the list of members of what is stored in one array.
struct NoFields {};

template <class Type>
struct FieldsOfType {
  using List = NoFields;
};
template <HasFields Record>
struct FieldsOfType<Record> {
  using List = typename Record::Fields;
};
template <class Real>
struct FieldsOfType<Vec2<Real>> {
  using List = FieldList<&Vec2<Real>::x, &Vec2<Real>::y>;
};
template <class Real>
struct FieldsOfType<Vec3<Real>> {
  using List = FieldList<&Vec3<Real>::x, &Vec3<Real>::y, &Vec3<Real>::z>;
};
template <class Type>
using FieldsOf = typename FieldsOfType<Type>::List;

/// The arrays of a number, of an array of records, or of the listed members of a record. `get` and `put` read and write
/// row i, `visit` calls visit(array) for each array.
template <class Type, class Storage, class Fields = FieldsOf<Type>>
struct StoredArrays {
  static_assert(sizeof(Type) <= 8, "a record needs a list of its members");

  typename Storage::template Array<Type> array;

  ALHAZEN_HD ALHAZEN_INLINE void get(uint32_t i, Type& value) const { value = array[i]; }
  template <class Self>
  ALHAZEN_HD static ALHAZEN_INLINE void put(Self& self, uint32_t i, const Type& value) {
    self.array[i] = value;
  }
  template <class Visit>
  void visit(const Visit& visit_array) {
    visit_array(array);
  }
};

template <class Type, size_t size, class Storage>
struct StoredArrays<Type[size], Storage, NoFields> {
  StoredArrays<Type, Storage> each[size];

  ALHAZEN_HD ALHAZEN_INLINE void get(uint32_t i, Type (&values)[size]) const {
    for (size_t k = 0; k < size; ++k) each[k].get(i, values[k]);
  }
  template <class Self>
  ALHAZEN_HD static ALHAZEN_INLINE void put(Self& self, uint32_t i, const Type (&values)[size]) {
    for (size_t k = 0; k < size; ++k) self.each[k].put(self.each[k], i, values[k]);
  }
  template <class Visit>
  void visit(const Visit& visit_array) {
    for (size_t k = 0; k < size; ++k) each[k].visit(visit_array);
  }
};

/// The arrays of one member of a record.
template <auto member, class Storage>
struct StoredField {
  StoredArrays<typename MemberOf<decltype(member)>::ValueType, Storage> arrays;
};

template <class Record, class Storage, auto... members>
struct StoredArrays<Record, Storage, FieldList<members...>> : StoredField<members, Storage>... {
  /// Row i; members that are not stored have the values of a default record.
  ALHAZEN_HD ALHAZEN_INLINE Record operator[](uint32_t i) const {
    Record record;
    get(i, record);
    return record;
  }
  ALHAZEN_HD ALHAZEN_INLINE void get(uint32_t i, Record& record) const {
    (StoredField<members, Storage>::arrays.get(i, record.*members), ...);
  }
  /// One member of row i.
  template <auto member>
  ALHAZEN_HD ALHAZEN_INLINE auto get_only(uint32_t i) const {
    typename MemberOf<decltype(member)>::ValueType value;
    StoredField<member, Storage>::arrays.get(i, value);
    return value;
  }

  ALHAZEN_HD ALHAZEN_INLINE void set(uint32_t i, const Record& record) { put(*this, i, record); }
  ALHAZEN_HD ALHAZEN_INLINE void set(uint32_t i,
                                     const Record& record) const requires std::is_same_v<Storage, PointerStorage> {
    put(*this, i, record);
  }
  /// Writes the given members only.
  template <auto... some>
  ALHAZEN_HD ALHAZEN_INLINE void set_only(uint32_t i, const Record& record) {
    (put_field<some>(*this, i, record), ...);
  }

  template <class Self>
  ALHAZEN_HD static ALHAZEN_INLINE void put(Self& self, uint32_t i, const Record& record) {
    (put_field<members>(self, i, record), ...);
  }
  template <class Visit>
  void visit(const Visit& visit_array) {
    (StoredField<members, Storage>::arrays.visit(visit_array), ...);
  }

 private:
  template <auto member, class Self>
  ALHAZEN_HD static ALHAZEN_INLINE void put_field(Self& self, uint32_t i, const Record& record) {
    using Field =
        std::conditional_t<std::is_const_v<Self>, const StoredField<member, Storage>, StoredField<member, Storage>>;
    Field& field = self;
    field.arrays.put(field.arrays, i, record.*member);
  }
};

/// `count` records, a multiple of 16.
template <class Record, uint32_t count, class Fields = FieldsOf<Record>>
using SoA = StoredArrays<Record, InlineStorage<count>, Fields>;

/// Records whose arrays are elsewhere.
template <class Record, class Fields = FieldsOf<Record>>
using SoAView = StoredArrays<Record, PointerStorage, Fields>;

/// The number `member` of row i.
template <auto member, class Storage, auto... members>
ALHAZEN_HD ALHAZEN_INLINE auto& element(
    const StoredArrays<typename MemberOf<decltype(member)>::RecordType, Storage, FieldList<members...>>& records,
    uint32_t i) {
  const StoredField<member, Storage>& field = records;
  return field.arrays.array[i];
}
template <auto member, class Storage, auto... members>
ALHAZEN_HD ALHAZEN_INLINE auto& element(
    StoredArrays<typename MemberOf<decltype(member)>::RecordType, Storage, FieldList<members...>>& records,
    uint32_t i) {
  StoredField<member, Storage>& field = records;
  return field.arrays.array[i];
}

template <class Record, auto... members>
ALHAZEN_HD ALHAZEN_INLINE Record select_members(bool first, const Record& a, const Record& b, FieldList<members...>) {
  Record selected;
  ((selected.*members = select(first, a.*members, b.*members)), ...);
  return selected;
}

/// Selects member by member, so that loops over rows stay without branches.
template <HasFields Record>
ALHAZEN_HD ALHAZEN_INLINE Record select(bool first, const Record& a, const Record& b) {
  return select_members(first, a, b, typename Record::Fields{});
}

}  // namespace ALHAZEN_CORE
