#pragma once

#include <ctime>

namespace alhazen::impl {

/// User and system time of the calling thread, in seconds.
inline double thread_processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace alhazen::impl
