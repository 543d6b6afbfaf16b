#include "scene/thread_limit.h"

#include <omp.h>
#include <pthread.h>
#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <vector>

namespace alhazen {

namespace {

/// A reporter of progress and one that waits for signals.
constexpr int threads_beside = 2;

/// Address space that must be left when all threads run: allocators of theirs reserve some each, and a scene has to
/// fit in.
constexpr size_t spare_bytes = size_t{64} << 20;

/// Holds threads until all that can be started are.
class Gate {
 public:
  void wait() {
    std::unique_lock lock(mutex_);
    opened_.wait(lock, [this] { return is_open_; });
  }
  void open() {
    const std::lock_guard lock(mutex_);
    is_open_ = true;
    opened_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable opened_;
  bool is_open_ = false;
};

void* wait_at(void* gate) {
  static_cast<Gate*>(gate)->wait();
  return nullptr;
}

/// OpenMP's threads too are started with the default.
void raise_default_stack() {
  pthread_attr_t attributes;
  if (::pthread_getattr_default_np(&attributes) != 0) return;
  size_t size = 0;
  if (::pthread_attr_getstacksize(&attributes, &size) == 0 && size < thread_stack_bytes &&
      ::pthread_attr_setstacksize(&attributes, thread_stack_bytes) == 0)
    ::pthread_setattr_default_np(&attributes);
  ::pthread_attr_destroy(&attributes);
}

/// How many of `count` threads can be started beside each other.
int start_and_end(int count) {
  void* const spare = ::mmap(nullptr, spare_bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  Gate gate;
  std::vector<pthread_t> threads;
  threads.reserve(static_cast<size_t>(count));
  pthread_t thread{};
  while (static_cast<int>(threads.size()) < count && ::pthread_create(&thread, nullptr, wait_at, &gate) == 0)
    threads.push_back(thread);
  gate.open();
  for (const pthread_t started : threads) ::pthread_join(started, nullptr);
  if (spare != MAP_FAILED) ::munmap(spare, spare_bytes);
  return static_cast<int>(threads.size());
}

}  // namespace

int threads_available(int wanted) {
  static std::atomic<int> known{1};
  static std::once_flag raised;
  std::call_once(raised, raise_default_stack);
  if (wanted <= known.load()) return wanted;
  const int asked = wanted - 1 + threads_beside;
  const int started = start_and_end(asked);
  const int available = started == asked ? wanted : std::max(1, started + 1 - threads_beside);
  int before = known.load();
  while (before < available && !known.compare_exchange_weak(before, available)) {
  }
  return available;
}

void limit_default_team() {
  const int team = omp_get_max_threads(), available = threads_available(team);
  if (available < team) omp_set_num_threads(available);
}

}  // namespace alhazen
