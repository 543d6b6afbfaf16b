#include "util/thread_limit.h"

#include <omp.h>
#include <pthread.h>
#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <vector>

#include "util/diagnostics.h"

namespace alhazen::impl {

namespace {

/// Threads that run beside a render: the progress reporter and the one that waits for signals.
constexpr int threads_beside = 2;

/// Address space that must remain when all threads run: their allocators reserve some for each thread, and the scene
/// must fit. In bytes.
constexpr size_t spare_bytes = size_t{64} << 20;

/// Blocks the started threads until no more are to be started.
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

/// The original default stack size, kept while any ThreadDefaults exists.
struct DefaultStack {
  std::mutex mutex;
  int users = 0;
  size_t before = 0;  ///< bytes; 0: it was large enough
};

DefaultStack& default_stack() {
  static DefaultStack stack;
  return stack;
}

/// Sets the default to the result of `choose`; 0 leaves it unchanged. Returns the previous value, or 0 if unchanged.
template <class Choose>
size_t change_default_stack(const Choose& choose) {
  pthread_attr_t attributes;
  if (::pthread_getattr_default_np(&attributes) != 0) return 0;
  size_t size = 0;
  bool is_set = false;
  if (::pthread_attr_getstacksize(&attributes, &size) == 0)
    if (const size_t wanted = choose(size); wanted > 0 && ::pthread_attr_setstacksize(&attributes, wanted) == 0)
      is_set = ::pthread_setattr_default_np(&attributes) == 0;
  ::pthread_attr_destroy(&attributes);
  return is_set ? size : 0;
}

/// Tries to start `count` concurrent threads and returns how many were started.
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

/// The threads of OpenMP do not survive fork(), and GCC's library would wait for them forever at the next loop of the
/// thread that forked. It ends them before.
[[maybe_unused]] const int registered =
    pthread_atfork([] { omp_pause_resource_all(omp_pause_soft); }, nullptr, nullptr);

}  // namespace

ThreadDefaults::ThreadDefaults() : team_(omp_get_max_threads()) {
  DefaultStack& stack = default_stack();
  const std::lock_guard lock(stack.mutex);
  if (stack.users++ > 0) return;
  // The threads of OpenMP use this default too.
  stack.before = change_default_stack([](size_t size) { return size < thread_stack_bytes ? thread_stack_bytes : 0; });
}

ThreadDefaults::~ThreadDefaults() {
  omp_set_num_threads(team_);
  DefaultStack& stack = default_stack();
  const std::lock_guard lock(stack.mutex);
  if (--stack.users > 0 || stack.before == 0) return;
  // If other code has set a new value since then, it is kept.
  change_default_stack([&](size_t size) { return size == thread_stack_bytes ? stack.before : 0; });
}

int threads_available(int wanted) {
  static std::atomic<int> known{1};
  if (wanted <= known.load()) return wanted;
  const int asked = wanted - 1 + threads_beside;
  const int started = start_and_end(asked);
  const int available = started == asked ? wanted : std::max(1, started + 1 - threads_beside);
  int before = known.load();
  while (before < available && !known.compare_exchange_weak(before, available)) {
  }
  return available;
}

void refuse_thread(const std::string& purpose, const std::system_error& error) {
  throw RenderError(purpose + " cannot be started: " + error.code().message() +
                    ": raise what limits threads or memory (ulimit -u, ulimit -v, ulimit -d, the container's pids or "
                    "memory)");
}

void limit_default_team() {
  const int team = omp_get_max_threads(), available = threads_available(team);
  if (available < team) omp_set_num_threads(available);
}

}  // namespace alhazen::impl
