// `alhazen view`: shows a scene in a browser, rendered while one looks at it and moves the camera.

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/interrupt.h"
#include "cli/listing.h"
#include "cli/setting_options.h"
#include "cli/subcommands.h"
#include "files/input_file.h"
#include "render/setting_table.h"
#include "util/printable.h"
#include "view/page_sender.h"
#include "view/page_server.h"
#include "view/view_session.h"

extern char** environ;

namespace alhazen::impl {

namespace {

struct ViewCommand {
  std::string scene;
  Settings settings;
  std::string address = "127.0.0.1";
  int port = 0;
  int viewers = 16;
  bool opens = false;
};

LoadOptions take_load_options(Settings& s) {
  LoadOptions load;
  load.camera = std::exchange(s.camera, {});
  load.variant = std::exchange(s.variant, {});
  load.animation = std::exchange(s.animation, {});
  load.time = std::exchange(s.animation_time, {});
  load.shutter = std::exchange(s.shutter, {});
  load.frames_per_second = s.frames_per_second;
  load.definitions = std::exchange(s.definitions, {});
  load.search_paths = s.search_paths;
  load.confine = s.confine;
  load.strict = s.strict;
  return load;
}

std::string in_shell(const std::string& text) {
  constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
  if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

/// The options that were given, but for those that a page has values of its own for.
std::string repeated_options(const Settings& settings) {
  std::string options;
  for (const SettingEntry& entry : setting_table()) {
    const std::string name = entry.name, text = entry.text(settings);
    const bool is_of_page = name == "size" || name == "spp" || name == "look-at" || name == "orbit" || name == "fit" ||
                            name == "fov" || name == "aperture" || name == "focus" || name == "environment-rotate" ||
                            name == "environment-strength" || name == "light-scale" || name == "time";
    if (is_of_page || text.empty() || text == entry.text(Settings())) continue;
    options += (options.empty() ? "--" : " --") + name;
    if (*entry.value_name != '\0') options += " " + in_shell(text);
  }
  return options;
}

/// Starts the browser that the desktop prefers, with no file of this program open in it.
void open_browser(const std::string& url) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
  std::string program = "xdg-open", argument = url;
  char* const arguments[] = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);  // so that Ctrl-C does not reach it
  const int problem = posix_spawnp(&child, program.c_str(), &actions, &attributes, arguments, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (problem != 0) tell("warning: no browser can be started (xdg-open is missing): open the address yourself\n");
}

/// Nothing is sent by the server once this ends, before it.
class Attachment {
 public:
  Attachment(PageSender& sender, PageServer& server) : sender_(sender) { sender.set_server(&server); }
  ~Attachment() { sender_.set_server(nullptr); }
  Attachment(const Attachment&) = delete;
  Attachment& operator=(const Attachment&) = delete;

 private:
  PageSender& sender_;
};

ViewOptions view_options(ViewCommand& command) {
  ViewOptions options;
  options.scene = command.scene;
  try {
    options.cameras = list_choices(command.scene, command.settings).cameras;
    for (size_t i = 0; i < options.cameras.size(); ++i)
      if (options.cameras[i].empty()) options.cameras[i] = fmt::format("camera {}", i);
  } catch (const InputError&) {
    // Reading the scene says it again, to the page too.
  }
  options.options = repeated_options(command.settings);
  options.load = take_load_options(command.settings);
  options.settings = command.settings;
  options.report = [](const std::string& line) { tell("{}\n", line); };
  return options;
}

int run(ViewCommand& command) {
  { const InputFile exists(command.scene); }
  PageSender sender;
  ViewSession session(view_options(command), sender);
  PageServerOptions server_options;
  server_options.address = command.address;
  server_options.port = command.port;
  server_options.max_viewers = static_cast<size_t>(command.viewers);
  PageServer server(server_options, session.events());
  const Attachment attached(sender, server);
  catch_interrupts();
  session.start();
  if (!server.is_local())
    tell("warning: everyone who can reach {} and has the address of the page sees the scene and can change the view\n",
         printable(command.address));
  print_out("{}\n", server.url());
  const std::string problem = flush_output();
  if (!problem.empty()) throw Error(problem);
  if (server.is_local())
    tell("from another machine: ssh -L {0}:127.0.0.1:{0} THIS_MACHINE, then open the same address there; Ctrl-C ends\n",
         server.port());
  if (command.opens) open_browser(server.url());
  while (!is_interrupted()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  session.stop();
  switch (session.failure()) {
    case ViewFailure::input:
      return exit_bad_input;
    case ViewFailure::other:
      return exit_failed;
    case ViewFailure::none:
      break;
  }
  return exit_interrupted;
}

}  // namespace

void register_view(Command& program, int& exit_code) {
  Command command = program.add_subcommand("view", "Show a scene in a browser while it is rendered");
  auto options = std::make_shared<ViewCommand>();
  command.add_option("SCENE", options->scene, "Scene (.pbrt, .gltf, .glb, .xml) or model (.obj, .ply, .stl)")
      .required()
      .value_name("");
  const char* page = "Page";
  command.add_option("--port", options->port, "Of the page's address; the next that is free if it is taken; 0: any")
      .within(0, 65535)
      .value_name("N")
      .group(page)
      .common();
  command
      .add_option("--listen", options->address,
                  "Address of this machine to serve the page on, for other machines; by default 127.0.0.1, for this "
                  "one alone")
      .value_name("ADDRESS")
      .group(page)
      .common();
  command.add_option("--viewers", options->viewers, "Most pages that are served at once, 16 by default")
      .within(1, 1000)
      .value_name("N")
      .group(page)
      .common();
  command.add_flag("--open", options->opens, "Open the page in the browser of this desktop").group(page).common();
  Settings& settings = options->settings;
  add_setting_options(command, settings, SettingGroup::image, "Image");
  add_setting_options(command, settings, SettingGroup::camera, "Camera");
  add_setting_options(command, settings, SettingGroup::light, "Light");
  add_setting_options(command, settings, SettingGroup::scene, "Scene");
  add_setting_options(command, settings, SettingGroup::animation, "Animation");
  add_setting_options(command, settings, SettingGroup::engine, "Engine");
  command.on_run([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace alhazen::impl
