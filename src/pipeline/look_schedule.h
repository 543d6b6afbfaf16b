#pragma once

// When somebody who watches a render looks at the image next.

#include <algorithm>
#include <chrono>

namespace alhazen::impl {

/// Looks are at least `interval` seconds apart, and `rarity` times as long as a look takes, so that they cost at most
/// one part in so many of the render. The first ones may come sooner: the very first after `delay` seconds, the next
/// ones after ten times what a look takes, then twenty times, and so on.
class LookSchedule {
 public:
  using Clock = std::chrono::steady_clock;

  LookSchedule(double delay, double interval, double rarity)
      : delay_(delay), interval_(interval), rarity_(rarity), next_(Clock::now()) {}

  /// An image begins.
  void begin(Clock::time_point now) {
    next_ = now + duration(delay_);
    factor_ = std::min(rarity_, first_factor);
  }

  double seconds_left(Clock::time_point now) const { return std::chrono::duration<double>(next_ - now).count(); }

  /// A look that took so many seconds has ended.
  void has_looked(Clock::time_point now, double seconds) {
    next_ = now + duration(std::max(interval_, factor_ * seconds));
    factor_ = std::min(rarity_, 2 * factor_);
  }

 private:
  static constexpr double first_factor = 10;

  static Clock::duration duration(double seconds) {
    constexpr double longest = 1e9;  // a clock cannot count to any number
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(seconds, longest)));
  }

  double delay_, interval_, rarity_;
  double factor_ = first_factor;
  Clock::time_point next_;
};

}  // namespace alhazen::impl
