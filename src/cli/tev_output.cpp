#include "cli/tev_output.h"

#include <unistd.h>

#include <algorithm>
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
    Image image{source.width, source.height, {}, {}};
    std::vector<size_t> kept;
    for (size_t c = 0; c < source.channels.size(); ++c)
      if (source.channels[c].find('.') == std::string::npos) kept.push_back(c);
    const auto width = static_cast<size_t>(source.width);
    for (const size_t c : kept) image.channels.push_back(source.channels[c]);
    image.planes.assign(kept.size(), std::vector<float>(width * static_cast<size_t>(source.height)));
    std::vector<float> row(width * source.channels.size());
    for (int y = 0; y < source.height; ++y) {
      source.fill_row(y, row);
      for (size_t k = 0; k < kept.size(); ++k)
        std::copy_n(row.begin() + static_cast<ptrdiff_t>(kept[k] * width), width,
                    image.planes[k].begin() + static_cast<ptrdiff_t>(static_cast<size_t>(y) * width));
    }
    return image;
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
