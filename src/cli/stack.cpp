#include "cli/stack.h"

#include <pthread.h>
#include <sys/resource.h>

#include "util/thread_limit.h"

namespace alhazen {

namespace {

struct Call {
  const std::function<int()>& body;
  int result = 0;
};

void* make_call(void* call) {
  auto* const c = static_cast<Call*>(call);
  c->result = c->body();
  return nullptr;
}

}  // namespace

int run_on_enough_stack(const std::function<int()>& body) {
  const ThreadDefaults defaults;
  rlimit limit{};
  if (::getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= thread_stack_bytes) return body();
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

}  // namespace alhazen
