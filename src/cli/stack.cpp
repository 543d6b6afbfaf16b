#include "cli/stack.h"

#include <malloc.h>
#include <pthread.h>
#include <sys/resource.h>

#include "util/thread_limit.h"

namespace alhazen::impl {

namespace {

struct Call {
  const std::function<int()>& body;
  int result = 0;
};

/// Under a limit on the address space (ulimit -v) the heap may take what the stack would grow into.
bool main_stack_may_grow() {
  rlimit stack{}, address_space{};
  if (::getrlimit(RLIMIT_STACK, &stack) != 0 || ::getrlimit(RLIMIT_AS, &address_space) != 0) return true;
  return stack.rlim_cur >= thread_stack_bytes && address_space.rlim_cur == RLIM_INFINITY;
}

void* make_call(void* call) {
  auto* const c = static_cast<Call*>(call);
  c->result = c->body();
  return nullptr;
}

}  // namespace

int run_on_enough_stack(const std::function<int()>& body) {
  const ThreadDefaults defaults;
  if (main_stack_may_grow()) return body();
  ::mallopt(M_ARENA_MAX, 1);  // the heap of another thread would reserve 64 MiB of address space
  pthread_attr_t attributes;
  ::pthread_attr_init(&attributes);
  ::pthread_attr_setstacksize(&attributes, thread_stack_bytes);
  Call call{body};
  pthread_t thread{};
  const bool is_running = ::pthread_create(&thread, &attributes, make_call, &call) == 0;
  ::pthread_attr_destroy(&attributes);
  if (!is_running) return body();
  ::pthread_join(thread, nullptr);
  return call.result;
}

}  // namespace alhazen::impl
