#include "cli/tev_output.h"

#include <unistd.h>

#include <utility>

namespace alhazen::impl {

namespace {

class TevOutput final : public LiveOutput {
 public:
  TevOutput(const TevAddress& address, uint64_t max_bytes, std::function<void(const std::string&)> warn)
      : client_(address), max_bytes_(max_bytes), warn_(std::move(warn)) {}

  void begin(const std::string& name) override { name_ = name; }

  void look(const Rendering& so_far) override {
    client_.show(name_, copy_of(so_far.source()));
    tell_problem();
  }

  double take_other_seconds() override { return client_.take_seconds(); }

  void finish(const Rendering& rendering) override {
    look(rendering);
    client_.flush();
    tell_problem();
  }

 private:
  void tell_problem() {
    if (const std::string problem = client_.take_problem(); !problem.empty()) warn_(problem);
  }

  Image copy_of(const ImageSource& source) {
    const uint64_t plane = sizeof(float) * static_cast<uint64_t>(source.width) * static_cast<uint64_t>(source.height);
    if (plane * source.channels.size() <= max_bytes_) return image_of(source);
    if (!std::exchange(has_left_out_, true))
      warn_("tev gets the colours alone: all layers together take " +
            std::to_string((plane * source.channels.size()) >> 20) + " MiB, too much for copies of them");
    return image_of(source, [](const std::string& channel) { return channel.find('.') == std::string::npos; });
  }

  TevClient client_;
  uint64_t max_bytes_;
  std::function<void(const std::string&)> warn_;
  std::string name_;
  bool has_left_out_ = false;
};

}  // namespace

std::unique_ptr<LiveOutput> make_tev_output(const TevAddress& address, uint64_t max_bytes,
                                            std::function<void(const std::string&)> warn) {
  return std::make_unique<TevOutput>(address, max_bytes, std::move(warn));
}

uint64_t max_tev_bytes() {
  return static_cast<uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<uint64_t>(sysconf(_SC_PAGESIZE)) / 16;
}

}  // namespace alhazen::impl
