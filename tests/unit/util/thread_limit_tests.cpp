// Process-wide thread settings are restored.

#include "util/thread_limit.h"

#include <gtest/gtest.h>
#include <omp.h>
#include <pthread.h>

#include <algorithm>

namespace alhazen::impl::test {

namespace {

size_t default_stack() {
  pthread_attr_t attributes;
  size_t size = 0;
  if (::pthread_getattr_default_np(&attributes) != 0) return 0;
  ::pthread_attr_getstacksize(&attributes, &size);
  ::pthread_attr_destroy(&attributes);
  return size;
}

void set_default_stack(size_t size) {
  pthread_attr_t attributes;
  ASSERT_EQ(::pthread_getattr_default_np(&attributes), 0);
  ASSERT_EQ(::pthread_attr_setstacksize(&attributes, size), 0);
  ASSERT_EQ(::pthread_setattr_default_np(&attributes), 0);
  ::pthread_attr_destroy(&attributes);
}

class ThreadLimits : public ::testing::Test {
 protected:
  ~ThreadLimits() override {
    set_default_stack(stack_);
    omp_set_num_threads(team_);
  }

 private:
  size_t stack_ = default_stack();
  int team_ = omp_get_max_threads();
};

TEST_F(ThreadLimits, DefaultsAreTakenBackWithTheLastUser) {
  constexpr size_t small = size_t{1} << 20, large = size_t{64} << 20;
  for (const size_t before : {small, large}) {
    set_default_stack(before);
    omp_set_num_threads(3);
    {
      const ThreadDefaults defaults;
      EXPECT_EQ(default_stack(), std::max(before, thread_stack_bytes));
      {
        const ThreadDefaults others;
        omp_set_num_threads(2);
      }
      EXPECT_EQ(default_stack(), std::max(before, thread_stack_bytes));
      EXPECT_EQ(omp_get_max_threads(), 3);
      omp_set_num_threads(1);
    }
    EXPECT_EQ(default_stack(), before);
    EXPECT_EQ(omp_get_max_threads(), 3);
  }
  set_default_stack(small);
  {
    const ThreadDefaults defaults;
    set_default_stack(large);
  }
  EXPECT_EQ(default_stack(), large) << "what somebody else has set";
}

}  // namespace

}  // namespace alhazen::impl::test
