#pragma once

// Temporary arrays of the tree builders, which initialize them themselves. Their memory is not cleared, and is on large
// pages if the system has them, since creating small pages costs as much as a pass over the data.

#include <cstddef>
#include <cstdlib>
#include <new>
#include <type_traits>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace alhazen::impl {

template <class T>
class LargeArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  LargeArray() = default;
  /// The elements are uninitialized. Throws std::bad_alloc.
  explicit LargeArray(size_t count) : size_(count) {
    constexpr size_t small = 64, large = size_t{1} << 21;
    const size_t bytes = count * sizeof(T), page = bytes >= 2 * large ? large : small;
    data_ = static_cast<T*>(std::aligned_alloc(page, (bytes + page - 1) / page * page));
    if (!data_ && bytes > 0) throw std::bad_alloc();
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    if (page == large) madvise(data_, bytes, MADV_HUGEPAGE);  // it is only an optimization, so failure is ignored
#endif
  }
  ~LargeArray() { std::free(data_); }
  LargeArray(const LargeArray&) = delete;
  LargeArray& operator=(const LargeArray&) = delete;

  void clear() {
    std::free(data_);
    data_ = nullptr;
    size_ = 0;
  }

  size_t size() const { return size_; }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
  T& operator[](size_t i) { return data_[i]; }
  const T& operator[](size_t i) const { return data_[i]; }

 private:
  T* data_ = nullptr;
  size_t size_ = 0;
};

}  // namespace alhazen::impl
