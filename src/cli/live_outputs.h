#pragma once

// What shows or keeps an image while it is rendered: --write-every, --tev, --terminal, --view.

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/look_schedule.h"
#include "render/renderer.h"

namespace alhazen::impl {

/// Called on the thread that renders.
class LiveOutput {
 public:
  virtual ~LiveOutput() = default;
  /// The name of the image that is rendered next, its first output.
  virtual void begin(const std::string& name) { (void)name; }
  /// Whether it would do anything with a look now.
  virtual bool wants_look() { return true; }
  /// Whether somebody waits for the look, so that it comes before its time.
  virtual bool is_urgent() { return false; }
  /// How long passes may be even while it wants no look, so that it can be urgent.
  virtual double max_pass_seconds() { return std::numeric_limits<double>::infinity(); }
  virtual void look(const Rendering& so_far) = 0;
  /// Processor time that another thread has spent on looks since this was asked last.
  virtual double take_other_seconds() { return 0; }
  /// The finished image has samples.
  virtual void finish(const Rendering& rendering) = 0;
};

/// All that is live about a render. Each has a schedule of its own, so that a slow one does not delay the others.
class LiveOutputs final : public RenderWatcher {
 public:
  /// `warn` is called on the thread that renders.
  explicit LiveOutputs(std::function<void(const std::string&)> warn) : warn_(std::move(warn)) {}

  void add(std::unique_ptr<LiveOutput> output, LookSchedule schedule);
  /// What RenderEvents has: null if nothing is live, so that nothing is done for it.
  RenderWatcher* watcher() { return outputs_.empty() ? nullptr : this; }
  void begin(const std::string& name);
  /// For a rendering with samples.
  void finish(const Rendering& rendering);

  double seconds_to_look() override;
  void look(const Rendering& so_far) override;
  void has_looked(double seconds) override;

 private:
  struct Scheduled {
    std::unique_ptr<LiveOutput> output;
    LookSchedule schedule;
    double looked = -1;  ///< seconds of the look that is being counted; less than 0: it did not look

    double seconds_left() const;
  };

  /// What `call` throws becomes a warning: the render goes on.
  template <class Call>
  void guard(const Call& call);

  std::function<void(const std::string&)> warn_;
  std::vector<Scheduled> outputs_;
  int threads_ = 1;  ///< that render, as far as they use the processors
};

}  // namespace alhazen::impl
