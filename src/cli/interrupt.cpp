#include "cli/interrupt.h"

#include <atomic>
#include <csignal>

namespace alhazen {

namespace {

std::atomic<bool> interrupted{false};

extern "C" void handle_interrupt(int signal_number) {
  interrupted.store(true, std::memory_order_relaxed);
  std::signal(signal_number, SIG_DFL);
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, handle_interrupt);
  std::signal(SIGTERM, handle_interrupt);
}

bool is_interrupted() { return interrupted.load(std::memory_order_relaxed); }

}  // namespace alhazen
