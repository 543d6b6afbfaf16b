#include "cli/rewritten_outputs.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace alhazen::impl {

namespace {

class RewrittenOutputs final : public LiveOutput {
 public:
  RewrittenOutputs(OutputOptions output, std::function<void(const std::string&)> warn)
      : output_(std::move(output)), warn_(std::move(warn)) {
    std::erase_if(output_.paths, [](const std::string& path) { return !can_be_rewritten(path); });
  }

  bool wants_look() override { return !output_.paths.empty(); }

  void look(const Rendering& so_far) override {
    OutputOptions now = output_;
    if (std::any_of(now.paths.begin(), now.paths.end(), is_displayed_format))
      choose_display(so_far, now.display, now.how);
    const OutputReport report = write_outputs(now, so_far);
    if (report.failures.empty() || std::exchange(has_warned_, true)) return;
    warn_("the image so far was not written, and the render goes on: " + report.failures.front());
  }

  /// The end of the render writes them all.
  void finish(const Rendering&) override {}

 private:
  OutputOptions output_;
  std::function<void(const std::string&)> warn_;
  bool has_warned_ = false;
};

}  // namespace

bool can_be_rewritten(const std::string& path) {
  if (path == standard_output_name) return false;
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  return status.type() == std::filesystem::file_type::regular || status.type() == std::filesystem::file_type::not_found;
}

std::unique_ptr<LiveOutput> make_rewritten_outputs(OutputOptions output, std::function<void(const std::string&)> warn) {
  return std::make_unique<RewrittenOutputs>(std::move(output), std::move(warn));
}

}  // namespace alhazen::impl
