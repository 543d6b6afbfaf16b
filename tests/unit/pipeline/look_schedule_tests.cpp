// When images are looked at while they are rendered.

#include "pipeline/look_schedule.h"

#include <gtest/gtest.h>

namespace alhazen::impl::test {

namespace {

using Clock = LookSchedule::Clock;

Clock::time_point after(double seconds) {
  return Clock::time_point() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

TEST(LookSchedule, WaitsForItsIntervalAndAHundredTimesWhatALookTakes) {
  LookSchedule schedule(0, 0.5, 100);
  schedule.begin(after(0));
  EXPECT_LE(schedule.seconds_left(after(0)), 0) << "the first one as soon as there is something";
  double now = 0;
  for (const double factor : {10.0, 20.0, 40.0, 80.0, 100.0, 100.0}) {
    schedule.has_looked(after(now), 0.2);
    EXPECT_NEAR(schedule.seconds_left(after(now)), 0.2 * factor, 1e-6);
    now += 0.2 * factor;
    EXPECT_NEAR(schedule.seconds_left(after(now)), 0, 1e-6);
  }
  schedule.has_looked(after(now), 0.001);
  EXPECT_NEAR(schedule.seconds_left(after(now)), 0.5, 1e-6);
  schedule.begin(after(now));
  schedule.has_looked(after(now), 0.2);
  EXPECT_NEAR(schedule.seconds_left(after(now)), 2, 1e-6) << "another image begins anew";
}

/// However long looks take, after the first four they are a hundredth of the time.
TEST(LookSchedule, CostsAHundredth) {
  LookSchedule schedule(0, 0.1, 100);
  schedule.begin(after(0));
  double now = 0, looked = 0;
  for (int i = 0; i < 4 + 1000; ++i) {
    const double seconds = 0.01 * (1 + i % 7);
    now += std::max(0.0, schedule.seconds_left(after(now)));
    if (i >= 4) looked += seconds;
    now += seconds;
    schedule.has_looked(after(now), seconds);
  }
  EXPECT_LT(looked / now, 0.01);
  EXPECT_GT(looked / now, 0.009);
}

TEST(LookSchedule, BeginsLaterWhereThatIsWanted) {
  LookSchedule schedule(30, 30, 10);
  schedule.begin(after(5));
  EXPECT_NEAR(schedule.seconds_left(after(5)), 30, 1e-6);
  schedule.has_looked(after(40), 1e300);
  EXPECT_GT(schedule.seconds_left(after(40)), 1e8);
}

}  // namespace

}  // namespace alhazen::impl::test
