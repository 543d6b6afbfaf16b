#include "cli/console.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>

#include "cli/interrupt.h"

namespace alhazen::impl {

namespace {

constexpr int stderr_patience = 2000;  ///< milliseconds

std::atomic<bool> stderr_is_stuck{false};
std::string printed;
int stdout_error = 0;  ///< errno of the first failure

/// Writes wait without limit, unless the program has been asked to end.
constexpr int no_patience_limit = -1;
constexpr int interrupted_patience = 1000, poll_interval = 100;  ///< milliseconds

/// Writes all of `text`. Returns 0, EAGAIN if the stream accepts nothing for `patience` milliseconds, or another errno.
int write_all(int descriptor, std::string_view text, int patience) {
  for (int waited = 0; !text.empty();) {
    pollfd room{descriptor, POLLOUT, 0};
    const int ready = ::poll(&room, 1, patience == 0 ? 0 : poll_interval);
    if (ready < 0 && errno == EINTR) continue;
    if (ready == 0) {
      waited += poll_interval;
      const bool is_bounded = patience != no_patience_limit || is_interrupted();
      if (is_bounded && waited >= (patience == no_patience_limit ? interrupted_patience : patience)) return EAGAIN;
      continue;
    }
    // A pipe that is ready accepts PIPE_BUF bytes without blocking.
    constexpr size_t piece = 4096;
    const ssize_t written = ::write(descriptor, text.data(), std::min(text.size(), piece));
    if (written < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (written <= 0) return written < 0 ? errno : EIO;
    text.remove_prefix(static_cast<size_t>(written));
    waited = 0;
  }
  return 0;
}

/// The next file opened would get the number of a closed descriptor: messages for stderr would end up in an image.
void fill_if_closed(int descriptor) {
  if (::fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) return;
  // Opened for reading only, so that writes fail. The lower descriptors are open, so this one is the next.
  if (::open("/dev/null", O_RDONLY) < 0) ::open("/", O_RDONLY);
}

void write_printed() {
  const int error = write_all(STDOUT_FILENO, printed, no_patience_limit);
  if (stdout_error == 0) stdout_error = error;
  printed.clear();
}

}  // namespace

void prepare_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) fill_if_closed(descriptor);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void tell_text(std::string_view text) {
  write_printed();  // a terminal shows both streams, so this keeps the order
  const int error = write_all(STDERR_FILENO, text, stderr_is_stuck ? 0 : stderr_patience);
  stderr_is_stuck = error == EAGAIN;
}

void tell_progress(std::string_view text) { write_all(STDERR_FILENO, text, 0); }

void print_text(std::string_view text) { printed += text; }

std::string flush_output() {
  write_printed();
  // CLI11 prints its output, such as --help, to std::cout.
  errno = 0;  // streams that have failed before do not set it
  std::cout.flush();
  const bool has_failed = !std::cout.good() || std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
  if (has_failed && stdout_error == 0) stdout_error = errno ? errno : EIO;
  if (stdout_error == 0) return {};
  return std::string("cannot write to the standard output: ") + std::strerror(stdout_error);
}

}  // namespace alhazen::impl
