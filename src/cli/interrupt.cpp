#include "cli/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <ctime>

#include "files/atomic_file.h"

namespace alhazen::impl {

namespace {

constexpr int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGXCPU};

std::atomic<bool> interrupted{false};
std::atomic<int64_t> asked_at{0};  ///< nanoseconds; time of the first signal other than SIGXCPU; 0: not yet
static_assert(std::atomic<int64_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free,
              "a signal handler takes no locks");

/// True if SIGINT and SIGQUIT were ignored at the start: a shell without job control has started the program in the
/// background, and Ctrl-C is meant for the foreground.
bool is_in_background = false;

int64_t now() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

std::atomic<bool> hung_up{false};

std::atomic<const char*> last_text{nullptr};
static_assert(std::atomic<const char*>::is_always_lock_free);

/// When a terminal closes, both its shell and the kernel send SIGHUP, and service managers send it together with
/// SIGTERM, in either order. Such repetitions do not mean that the user is impatient.
bool is_repeated_by_itself(int signal_number) {
  const bool is_one_of_a_pair = hung_up.load() && (signal_number == SIGHUP || signal_number == SIGTERM);
  return is_one_of_a_pair && now() - asked_at.load() < 1'000'000'000;
}

extern "C" void handle_interrupt(int signal_number, siginfo_t* info, void*) {
  const bool is_of_terminal = info->si_code > 0;
  if (is_in_background && signal_number == SIGINT && is_of_terminal) return;
  if (signal_number == SIGHUP) hung_up = true;
  interrupted = true;
  // A limit on processor time sends SIGXCPU every second, and batch systems send it before SIGTERM. It is no request of
  // the user, so one that follows is the first.
  if (signal_number == SIGXCPU) return;
  int64_t never = 0;
  if (asked_at.compare_exchange_strong(never, now())) return;
  if (is_repeated_by_itself(signal_number)) return;
  if (const char* const text = last_text.load())
    if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) last_text = nullptr;  // there is nothing else to do
  std::signal(signal_number, SIG_DFL);
  std::raise(signal_number);  // takes effect as this function returns
}

bool is_ignored(int signal_number) {
  struct sigaction action = {};
  return sigaction(signal_number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void catch_interrupts() {
  is_in_background = is_ignored(SIGINT) && is_ignored(SIGQUIT);
  for (const int signal_number : signals) {
    if (is_ignored(signal_number) && !(signal_number == SIGINT && is_in_background)) continue;
    struct sigaction action = {};
    action.sa_sigaction = handle_interrupt;
    action.sa_flags = SA_SIGINFO | SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(signal_number, &action, nullptr);
  }
  set_pipe_wait_is_over(is_interrupted);
}

void write_before_ending(const char* text) { last_text = text; }

bool is_interrupted() { return interrupted.load(std::memory_order_relaxed); }

}  // namespace alhazen::impl
