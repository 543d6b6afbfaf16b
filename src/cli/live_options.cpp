#include "cli/live_options.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "cli/interrupt.h"
#include "cli/rewritten_outputs.h"
#include "cli/tev_output.h"
#include "io/read_scene.h"
#include "util/diagnostics.h"
#include "util/parse_numbers.h"
#include "util/quoted.h"
#include "view/tev_client.h"

namespace alhazen::impl {

namespace {

/// Looks may take a hundredth of the time of a render, but for the first ones. Files are written as often as asked, up
/// to a tenth of it.
constexpr double rarity = 100, rarity_of_files = 10;
constexpr double min_interval = 0.2;  ///< seconds
constexpr double max_write_every = 1e9, min_write_every = 0.01;

int parse_port(const std::string& text) {
  int port = 0;
  if (!parse_number(text, port) || port < 0 || port > 65535)
    throw InputError("--view must be a port, a whole number from 1 to 65535, or 0 for any that is free, not " +
                     quoted(text));
  return port;
}

}  // namespace

void add_live_options(Command& command, RenderOptions& o, const std::string& group) {
  command
      .add_option("--write-every", o.write_every,
                  "Write the files anew while it renders, this often at most, not denoised yet")
      .within(min_write_every, max_write_every)
      .value_name("SECONDS")
      .group(group);
  command
      .add_option("--tev", o.tev,
                  "Show the image and its layers in tev while it renders; at " + TevAddress{}.to_string() +
                      " if no address is given")
      .checked([](const std::string& text) { parse_tev_address(text); })
      .implied(TevAddress{}.to_string())
      .value_name("[HOST:PORT]")
      .group(group);
  command
      .add_option(
          "--view", o.view,
          "Show the image in a browser while it renders; read-only, at the URL that it prints, on a free port if "
          "none is given")
      .checked([](const std::string& text) { parse_port(text); })
      .implied("0")
      .value_name("[PORT]")
      .group(group)
      .common();
  command.add_flag("--terminal", o.terminal, "Draw the image in the terminal while it renders, in colours of 24 bits")
      .group(group);
}

void check_live_options(const RenderOptions& o) {
  if (o.write_every > 0 && o.is_sequence())
    throw InputError(
        "--write-every is for one image: a frame with some of its samples would be taken for a finished one when the "
        "same command is given again");
  const std::vector<std::string>& paths = o.output.paths;
  if (o.write_every > 0 && std::find(paths.begin(), paths.end(), standard_output_name) != paths.end())
    throw InputError("--write-every writes files anew, and -o - writes one image: give the image a file");
  if (!o.terminal) return;
  if (o.progress != "auto" && o.progress != "none")
    throw InputError("--terminal draws the image above the progress bar: give --progress auto or none with it, not " +
                     o.progress);
  check_terminal();
}

LiveRender::LiveRender(const RenderOptions& o, ProgressPrinter& printer, std::function<void(const std::string&)> warn)
    : outputs_(warn) {
  if (o.write_every > 0) {
    if (std::none_of(o.output.paths.begin(), o.output.paths.end(), can_be_rewritten))
      warn("--write-every has no effect: pipes and devices get the finished image alone");
    outputs_.add(make_rewritten_outputs(o.output, warn), LookSchedule(o.write_every, o.write_every, rarity_of_files));
  }
  if (!o.tev.empty())
    outputs_.add(make_tev_output(parse_tev_address(o.tev), max_tev_bytes(), warn),
                 LookSchedule(0, min_interval, rarity));
  if (!o.view.empty()) {
    ViewOutputOptions options;
    options.port = parse_port(o.view);
    options.outputs = o.output;
    // A frame with some of its samples would be taken for a finished one.
    if (o.is_sequence()) options.outputs.paths.clear();
    options.stop = interrupt;
    std::unique_ptr<ViewOutput> view = make_view_output(std::move(options));
    view_ = view.get();
    printer.tell_lines("view: " + view->url() + "\n");
    outputs_.add(std::move(view), LookSchedule(0, min_interval, rarity));
  }
  if (o.terminal) {
    auto terminal = std::make_unique<TerminalPicture>(o.output, printer);
    terminal_ = terminal.get();
    outputs_.add(std::move(terminal), LookSchedule(0, min_interval, rarity));
  }
}

RenderWatcher* LiveRender::begin(const std::string& name) {
  outputs_.begin(name);
  return outputs_.watcher();
}

void LiveRender::finish(const Rendering& rendering) {
  if (rendering.has_samples()) outputs_.finish(rendering);
}

void LiveRender::report(const Progress& progress) {
  if (view_) view_->report(progress);
  if (terminal_) terminal_->draw();
}

std::string shown_name(const std::vector<std::string>& paths, const std::string& scene) {
  for (const std::string& path : paths)
    if (path != standard_output_name) return path;
  return scene == standard_input_name ? "stdin" : std::filesystem::path(scene).filename().string();
}

}  // namespace alhazen::impl
