#include "cli/video.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <sstream>
#include <system_error>
#include <thread>

#include "cli/interrupt.h"
#include "files/atomic_file.h"
#include "files/file_identity.h"
#include "files/temporary_files.h"
#include "images/image.h"
#include "util/diagnostics.h"
#include "util/printable.h"

extern "C" char** environ;

namespace alhazen::impl {

namespace {

constexpr size_t shown_lines = 4;

constexpr int room_interval = 50;  ///< milliseconds between looks at a pipe without room
constexpr auto end_interval = std::chrono::milliseconds(5);

/// Seconds that ffmpeg has after an interrupt: without using the processor, and in all.
constexpr double idle_patience = 1.5, whole_patience = 30;
constexpr double least_work = 0.01;  ///< seconds on the processor that count as work

double seconds_of(clockid_t clock) {
  timespec time{};
  return ::clock_gettime(clock, &time) == 0
             ? static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec)
             : 0;
}

/// 0 if the process has ended.
double processor_seconds(pid_t process) {
  clockid_t clock{};
  return ::clock_getcpuclockid(process, &clock) == 0 ? seconds_of(clock) : 0;
}

/// The path of a program, searched for as execvp does; empty if there is none.
std::string program_path(const std::string& name) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path ? path : "/usr/local/bin:/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string file = (folder.empty() ? "." : folder) + "/" + name;
    struct stat status = {};
    if (::stat(file.c_str(), &status) == 0 && S_ISREG(status.st_mode) && ::access(file.c_str(), X_OK) == 0) return file;
  }
  return {};
}

/// MP4 takes sides of an even number of pixels alone.
int even(int side) { return side + side % 2; }

std::vector<std::string> arguments_of(const std::string& path, const std::string& temporary, int width, int height,
                                      double frames_per_second) {
  std::vector<std::string> all{"ffmpeg",     "-hide_banner",
                               "-loglevel",  "error",
                               "-nostats",   "-y",
                               "-f",         "rawvideo",
                               "-pix_fmt",   "rgb24",
                               "-s",         fmt::format("{}x{}", width, height),
                               "-framerate", fmt::format("{}", frames_per_second),
                               "-i",         "pipe:0"};
  const auto add = [&](std::initializer_list<const char*> more) { all.insert(all.end(), more.begin(), more.end()); };
  if (extension_of(path) == "gif")
    add({"-filter_complex", "split[a][b];[a]palettegen[palette];[b][palette]paletteuse", "-loop", "0", "-f", "gif"});
  else
    // sRGB has the primaries of BT.709 and nearly its transfer curve.
    add({"-vf", "scale=out_color_matrix=bt709:out_range=tv", "-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p",
         "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1", "-movflags", "+faststart",
         "-f", "mp4"});
  all.push_back("file:" + temporary);
  return all;
}

/// In delays of a GIF: hundredths of a second.
constexpr double gif_ticks = 100, gif_min_delay = 2, gif_max_delay = 65535;

}  // namespace

bool is_video(const std::string& path) {
  const std::string extension = extension_of(path);
  return extension == "mp4" || extension == "gif";
}

void check_video(const std::string& path) {
  if (program_path("ffmpeg").empty())
    throw InputError({path},
                     "videos are written by the program ffmpeg, and there is none in the folders of PATH: install it "
                     "(apt-get install ffmpeg), or write the frames as images, -o NAME_####.png");
  check_target(path);
  int error = 0;
  struct stat status = {};
  if (::stat(follow_links(path, error).c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    throw InputError({path}, "a video is written to a file, and this is something else: give another name");
}

double playable_rate(const std::string& path, double frames_per_second) {
  if (extension_of(path) != "gif") return frames_per_second;
  return std::clamp(frames_per_second, gif_ticks / gif_max_delay, gif_ticks / gif_min_delay);
}

VideoWriter::VideoWriter(const std::string& path, int width, int height, double frames_per_second)
    : path_(path), width_(width), height_(height) {
  int error = 0;
  target_ = follow_links(path, error);
  if (error != 0) throw WriteError(path_, error);
  try {
    create_temporary();
    start(playable_rate(path, frames_per_second));
  } catch (...) {
    end();
    throw;
  }
}

VideoWriter::~VideoWriter() { end(); }

void VideoWriter::end() {
  if (pipe_ >= 0) ::close(pipe_);
  pipe_ = -1;
  if (process_ > 0) {
    ::kill(-process_, SIGKILL);  // with what it has started
    while (::waitpid(process_, &status_, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
  }
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
  if (lock_ >= 0) ::close(lock_);
  if (messages_ >= 0) ::close(messages_);
  lock_ = messages_ = -1;
}

/// ffmpeg opens it again by its name; the lock tells other processes that it is in use.
void VideoWriter::create_temporary() {
  const std::string folder = folder_of_path(target_);
  remove_abandoned_temporaries(folder);
  const std::string name = temporary_path(folder);
  lock_ = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (lock_ < 0) throw WriteError(path_, errno);
  temporary_ = name;
  lock_temporary(lock_);
  struct stat existing = {};
  if (::stat(target_.c_str(), &existing) == 0) ::fchmod(lock_, existing.st_mode & 0777);
}

void VideoWriter::start(double frames_per_second) {
  const bool is_gif = extension_of(path_) == "gif";
  const int width = is_gif ? width_ : even(width_), height = is_gif ? height_ : even(height_);
  if (width != width_ || height != height_)
    padded_.resize(3 * static_cast<size_t>(width) * static_cast<size_t>(height));
  std::array<int, 2> ends{};
  messages_ = ::memfd_create("ffmpeg", MFD_CLOEXEC);
  if (messages_ < 0 || ::pipe2(ends.data(), O_CLOEXEC) != 0) throw WriteError(path_, errno);
  pipe_ = ends[1];
  ::fcntl(pipe_, F_SETFL, O_WRONLY | O_NONBLOCK);
  const std::string program = program_path("ffmpeg");
  std::vector<std::string> arguments = arguments_of(path_, temporary_, width, height, frames_per_second);
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, messages_, STDERR_FILENO);
  posix_spawnattr_init(&attributes);
  // Ctrl-C goes to the whole group of the terminal; ffmpeg then still writes the frames that are finished.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  sigset_t standard;
  sigemptyset(&standard);
  for (const int signal_number : {SIGPIPE, SIGXFSZ}) sigaddset(&standard, signal_number);
  posix_spawnattr_setsigdefault(&attributes, &standard);
  const int error = ::posix_spawn(&process_, program.empty() ? "ffmpeg" : program.c_str(), &files, &attributes,
                                  pointers.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  ::close(ends[0]);
  if (error != 0) {
    process_ = -1;
    throw RenderError("cannot write " + path_ + ": ffmpeg does not start: " + std::strerror(error));
  }
}

void VideoWriter::add(std::span<const uint8_t> frame) {
  std::span<const uint8_t> left = frame;
  if (!padded_.empty()) {  // the last row and column are repeated
    const size_t row = 3 * static_cast<size_t>(width_), padded_row = 3 * static_cast<size_t>(even(width_));
    for (int y = 0; y < even(height_); ++y) {
      const uint8_t* from = frame.data() + row * static_cast<size_t>(std::min(y, height_ - 1));
      uint8_t* to = padded_.data() + padded_row * static_cast<size_t>(y);
      std::memcpy(to, from, row);
      if (padded_row > row) std::memcpy(to + row, from + row - 3, 3);
    }
    left = padded_;
  }
  send(left);
}

/// Waits for room in the pipe, after an interrupt only while ffmpeg works.
void VideoWriter::send(std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(pipe_, bytes.data(), bytes.size());
    if (written > 0) {
      bytes = bytes.subspan(static_cast<size_t>(written));
      worked_at_ = 0;
      continue;
    }
    if (written == 0 || (errno != EINTR && errno != EAGAIN)) {
      wait_briefly();
      fail(process_ > 0 ? "ffmpeg takes no more frames" : how_it_ended() + " before it had all frames");
    }
    if (stands_still()) give_up();
    pollfd room{pipe_, POLLOUT, 0};
    ::poll(&room, 1, room_interval);
  }
}

bool VideoWriter::has_ended() {
  if (process_ > 0 && ::waitpid(process_, &status_, WNOHANG) != 0) process_ = -1;
  return process_ < 0;
}

/// Returns whether an interrupt was a while ago, and ffmpeg does nothing, or does not come to its end.
bool VideoWriter::stands_still() {
  if (!is_interrupted()) return false;
  const double now = seconds_of(CLOCK_MONOTONIC), worked = processor_seconds(process_);
  if (asked_at_ == 0) asked_at_ = now;
  if (worked_at_ == 0 || worked > worked_ + least_work) {
    worked_at_ = now;
    worked_ = worked;
  }
  return now - worked_at_ > idle_patience || now - asked_at_ > whole_patience;
}

void VideoWriter::wait() {
  worked_at_ = 0;
  while (!has_ended()) {
    if (stands_still()) give_up();
    std::this_thread::sleep_for(end_interval);
  }
}

/// One that takes no more frames is about to end, or never will.
void VideoWriter::wait_briefly() {
  for (const double since = seconds_of(CLOCK_MONOTONIC); !has_ended();) {
    if (seconds_of(CLOCK_MONOTONIC) - since > idle_patience) return;
    std::this_thread::sleep_for(end_interval);
  }
}

void VideoWriter::give_up() {
  end();
  throw VideoInterrupted("ffmpeg stood still and was ended, and " + printable(path_) + " is not written");
}

/// The end of what ffmpeg has said.
std::string VideoWriter::messages() const {
  std::string text(4096, '\0');
  const off_t size = ::lseek(messages_, 0, SEEK_END);
  const off_t from = std::max<off_t>(0, size - static_cast<off_t>(text.size()));
  const ssize_t count = ::pread(messages_, text.data(), text.size(), from);
  text.resize(count > 0 ? static_cast<size_t>(count) : 0);
  return text;
}

std::string VideoWriter::how_it_ended() const {
  if (!WIFSIGNALED(status_)) return "ffmpeg ended with exit code " + std::to_string(WEXITSTATUS(status_));
  const int number = WTERMSIG(status_);
  return "ffmpeg was ended by signal " + std::to_string(number) + " (" + ::strsignal(number) + ")";
}

/// A full disk and a limit are said as for images.
void VideoWriter::fail(const std::string& problem) {
  const std::string text = messages();
  if (process_ < 0 && WIFSIGNALED(status_) && WTERMSIG(status_) == SIGXFSZ) throw WriteError(path_, EFBIG);
  for (const int error : {ENOSPC, EDQUOT, EFBIG})
    if (text.find(std::generic_category().message(error)) != std::string::npos) throw WriteError(path_, error);
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (!line.empty()) lines.push_back(line);
  if (lines.size() > shown_lines) lines.erase(lines.begin(), lines.end() - static_cast<std::ptrdiff_t>(shown_lines));
  std::string said;
  for (const std::string& line : lines) said += "\n  " + printable(line);
  throw RenderError("cannot write " + path_ + ": " + problem + (said.empty() ? "" : "; it says:" + said));
}

/// The exit code alone does not tell: ffmpeg ends with 0 where the disk is full, and says so at the level `error`.
void VideoWriter::check_written() {
  if (WIFSIGNALED(status_) || WEXITSTATUS(status_) != 0) fail(how_it_ended());
  if (!messages().empty()) fail("ffmpeg reports an error");
  struct stat written = {};
  if (::stat(temporary_.c_str(), &written) != 0) throw WriteError(path_, errno);
  if (written.st_size == 0) fail("ffmpeg has written nothing");
  // Some network filesystems cannot sync and report it, as for images.
  if (::fsync(lock_) != 0 && errno != EINVAL && errno != EROFS && errno != ENOTSUP) throw WriteError(path_, errno);
}

void VideoWriter::finish() {
  ::close(pipe_);
  pipe_ = -1;
  wait();
  check_written();
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) throw WriteError(path_, errno);
  temporary_.clear();
}

}  // namespace alhazen::impl
