#pragma once

// Determines how many threads the system grants this process. OpenMP ends the program if it cannot start a thread, so
// the team size is tested in advance.

#include <cstddef>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace alhazen::impl {

/// Maximum stack size of a thread: recursive integrators, at most 1000 deep, need the most.
inline constexpr size_t thread_stack_bytes = size_t{8} << 20;

/// While one exists, threads are started with a stack of at least `thread_stack_bytes`, whatever `ulimit -s` says. Its
/// destructor restores the process's default, and OpenMP's setting on the calling thread, which must be the one that
/// constructed it.
class ThreadDefaults {
 public:
  ThreadDefaults();
  ~ThreadDefaults();
  ThreadDefaults(const ThreadDefaults&) = delete;
  ThreadDefaults& operator=(const ThreadDefaults&) = delete;

 private:
  int team_;  ///< threads
};

/// Returns how many threads, including the calling one and at most `wanted`, can run at the same time: limits on
/// processes, containers or memory may allow fewer than there are processors. To find out, it starts and ends that many
/// threads, plus two for those that run beside a render. A result of at least `wanted` is cached.
int threads_available(int wanted);

/// Throws the RenderError of a thread that the system refuses: which one, why, and which limits to raise.
[[noreturn]] void refuse_thread(const std::string& purpose, const std::system_error& error);

/// Starts a thread, which messages call by its `purpose` ("the thread that reports progress"). Throws RenderError if
/// the system refuses it.
template <class Body>
std::thread start_thread(const std::string& purpose, Body&& body) try {
  return std::thread(std::forward<Body>(body));
} catch (const std::system_error& error) {
  refuse_thread(purpose, error);
}

/// Limits the teams that OpenMP starts without a given size, on the calling thread, to the available threads; a
/// ThreadDefaults reverts that.
void limit_default_team();

}  // namespace alhazen::impl
