#pragma once

// Caches tables that take a while to compute for scenes that need the same ones: studies and interactive use compile a
// scene many times.

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace alhazen::impl {

using Table = std::shared_ptr<const std::vector<double>>;

/// The key holds all that a table depends on. The cache is thread-safe.
template <class Key>
class TableCache {
 public:
  /// Returns the result of compute() for that key. Two threads may compute the same table; neither waits for the other.
  template <class Compute>
  Table get(const Key& key, const Compute& compute) {
    if (Table known = find(key)) return known;
    const Table table = std::make_shared<const std::vector<double>>(compute());
    const std::lock_guard lock(mutex_);
    if (values_ + table->size() > max_values) tables_.clear(), values_ = 0;
    const auto [place, is_new] = tables_.try_emplace(key, table);
    if (is_new) values_ += table->size();
    return place->second;
  }

 private:
  static constexpr size_t max_values = size_t{1} << 23;  ///< 64 MiB

  Table find(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto place = tables_.find(key);
    return place == tables_.end() ? nullptr : place->second;
  }

  std::mutex mutex_;
  std::map<Key, Table> tables_;
  size_t values_ = 0;
};

}  // namespace alhazen::impl
