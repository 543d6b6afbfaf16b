#pragma once

// How many threads the system lets this process have. OpenMP ends the program where it cannot start a thread, so what
// it is asked for is tried before.

#include <cstddef>

namespace alhazen {

/// What the stack of a thread may grow to: integrators that call themselves, 1000 deep at most, need the most of it.
inline constexpr size_t thread_stack_bytes = size_t{8} << 20;

/// While one lives, threads that are started have a stack of `thread_stack_bytes` at least, whatever `ulimit -s` says.
/// At its end the default for the process's threads is as it was, and so is what OpenMP is told on the calling thread,
/// which must be the one that made it.
class ThreadDefaults {
 public:
  ThreadDefaults();
  ~ThreadDefaults();
  ThreadDefaults(const ThreadDefaults&) = delete;
  ThreadDefaults& operator=(const ThreadDefaults&) = delete;

 private:
  int team_;  ///< threads
};

/// The number of threads, the calling one included and at most `wanted`, that can run at the same time here: limits of
/// processes, of a container or of memory may allow fewer than there are processors. So many are started and ended
/// again, with two more for what runs beside a render; an answer that was `wanted` or more is remembered.
int threads_available(int wanted);

/// Keeps the teams that OpenMP starts without being told a number, on the calling thread, to what is available; a
/// ThreadDefaults takes that back.
void limit_default_team();

}  // namespace alhazen
