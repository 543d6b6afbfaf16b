#pragma once

// Lists of the members of a record. Whatever handles a record member by member (core/simd/soa.h) is generated from its
// list.

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

/// Pointers to members of one record. A record names those that make it up as its member type `Fields`.
template <auto... members>
struct FieldList {};

template <class Record>
concept HasFields = requires {
  typename Record::Fields;
};

template <class Member>
struct MemberOf;
template <class Record, class Value>
struct MemberOf<Value Record::*> {
  using RecordType = Record;
  using ValueType = Value;
};

}  // namespace ALHAZEN_CORE
