#include "cli/live_outputs.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <new>
#include <utility>

namespace alhazen::impl {

void LiveOutputs::add(std::unique_ptr<LiveOutput> output, LookSchedule schedule) {
  outputs_.push_back({std::move(output), schedule});
}

template <class Call>
void LiveOutputs::guard(const Call& call) {
  try {
    call();
  } catch (const std::bad_alloc&) {
    warn_("no memory was left to show the image while it is rendered; the render goes on");
  } catch (const std::exception& failure) {
    warn_(std::string("the image is not shown while it is rendered, and the render goes on: ") + failure.what());
  }
}

void LiveOutputs::begin(const std::string& name) {
  for (Scheduled& one : outputs_) {
    one.output->begin(name);
    one.schedule.begin(LookSchedule::Clock::now());
  }
}

double LiveOutputs::Scheduled::seconds_left() const {
  if (!output->wants_look()) return std::numeric_limits<double>::infinity();
  return output->is_urgent() ? 0 : schedule.seconds_left(LookSchedule::Clock::now());
}

double LiveOutputs::seconds_to_look() {
  double seconds = std::numeric_limits<double>::infinity();
  for (const Scheduled& one : outputs_)
    seconds = std::min({seconds, one.seconds_left(), one.output->max_pass_seconds()});
  return seconds;
}

void LiveOutputs::look(const Rendering& so_far) {
  for (Scheduled& one : outputs_) {
    const LookSchedule::Clock::time_point start = LookSchedule::Clock::now();
    one.looked = -1;
    if (one.seconds_left() > 0) continue;
    guard([&] { one.output->look(so_far); });
    one.looked = std::chrono::duration<double>(LookSchedule::Clock::now() - start).count();
  }
}

void LiveOutputs::has_looked(double seconds) {
  double others = seconds;  // what was done for all of them
  for (const Scheduled& one : outputs_) others -= std::max(0.0, one.looked);
  for (Scheduled& one : outputs_)
    if (one.looked >= 0)
      one.schedule.has_looked(LookSchedule::Clock::now(),
                              one.looked + std::max(0.0, others) + one.output->take_other_seconds());
}

void LiveOutputs::finish(const Rendering& rendering) {
  for (Scheduled& one : outputs_) guard([&] { one.output->finish(rendering); });
}

}  // namespace alhazen::impl
