#pragma once

// Runs the program with standard error on a terminal of its own, and keeps what that terminal shows.

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace alhazen::impl::test {

/// As much of a terminal as the program uses; anything else fails by std::runtime_error.
class TerminalScreen {
 public:
  using Colour = std::array<int, 3>;
  struct Cell {
    std::string character = " ";
    Colour fore{-1, -1, -1}, back{-1, -1, -1};  ///< -1: the terminal's own
    bool operator==(const Cell&) const = default;
  };

  TerminalScreen(int columns, int rows) { resize(columns, rows); }

  void resize(int columns, int rows) {
    columns_ = columns;
    rows_ = rows;
    cells_.resize(static_cast<size_t>(rows));
    for (auto& row : cells_) row.resize(static_cast<size_t>(columns));
    y_ = std::min(y_, rows - 1);
  }

  void write(const std::string& text) {
    pending_ += text;
    while (take_one()) {
    }
  }

  const std::vector<std::vector<Cell>>& cells() const { return cells_; }
  bool shows_cursor() const { return shows_cursor_; }
  int cleared() const { return cleared_; }
  bool has_own_colours() const { return pen_ == Cell{}; }

  std::string text_of(size_t row) const {
    std::string text;
    for (const Cell& cell : cells_.at(row)) text += cell.character;
    text.erase(text.find_last_not_of(' ') + 1);
    return text;
  }

 private:
  bool take_one() {
    if (pending_.empty()) return false;
    const auto c = static_cast<unsigned char>(pending_[0]);
    if (c == 0x1b) return take_escape();
    size_t size = c < 0x80 ? 1 : c < 0xe0 ? 2 : c < 0xf0 ? 3 : 4;
    if (pending_.size() < size) return false;
    const std::string character = pending_.substr(0, size);
    pending_.erase(0, size);
    if (character == "\r") {
      x_ = 0;
    } else if (character == "\n") {
      down();
    } else if (c < ' ') {
      throw std::runtime_error("a control character");
    } else {
      if (x_ == columns_) {
        x_ = 0;
        down();
      }
      Cell cell = pen_;
      cell.character = character;
      cells_[static_cast<size_t>(y_)][static_cast<size_t>(x_++)] = cell;
    }
    return true;
  }

  void down() {
    if (++y_ < rows_) return;
    y_ = rows_ - 1;
    cells_.erase(cells_.begin());
    cells_.emplace_back(static_cast<size_t>(columns_));
  }

  bool take_escape() {
    const size_t end = pending_.find_first_not_of("[?;0123456789", 1);
    if (end == std::string::npos) return false;
    const std::string code = pending_.substr(2, end - 2);
    const char command = pending_[end];
    // Another sequence begins: terminals drop the one that it interrupts, as the end by a second signal does.
    if (command == '\x1b') {
      pending_.erase(0, end);
      return true;
    }
    pending_.erase(0, end + 1);
    auto& row = cells_[static_cast<size_t>(y_)];
    if (command == 'A') {
      y_ = std::max(0, y_ - std::stoi(code));
    } else if (command == 'K') {
      std::fill(row.begin() + (code == "2" ? 0 : std::min(x_, columns_ - 1)), row.end(), Cell{});
    } else if (command == 'H' && code.empty()) {
      x_ = y_ = 0;
    } else if (command == 'J' && code == "2") {
      ++cleared_;
      for (auto& line : cells_) std::fill(line.begin(), line.end(), Cell{});
    } else if ((command == 'l' || command == 'h') && code == "?25") {
      shows_cursor_ = command == 'h';
    } else if (command == 'm') {
      colour(code);
    } else {
      throw std::runtime_error("an unknown command of the terminal: " + code + command);
    }
    return true;
  }

  void colour(const std::string& code) {
    int r = 0, g = 0, b = 0, ground = 0;
    if (code == "0")
      pen_ = {};
    else if (std::sscanf(code.c_str(), "%d;2;%d;%d;%d", &ground, &r, &g, &b) == 4 && (ground == 38 || ground == 48))
      (ground == 38 ? pen_.fore : pen_.back) = {r, g, b};
    else
      throw std::runtime_error("an unknown colour: " + code);
  }

  int columns_ = 0, rows_ = 0, x_ = 0, y_ = 0, cleared_ = 0;
  bool shows_cursor_ = true;
  Cell pen_;
  std::vector<std::vector<Cell>> cells_;
  std::string pending_;
};

struct TerminalResult {
  int exit_code = -1;  ///< 128 + the signal if one ended it
  std::string text;    ///< all that was written to the terminal
  bool timed_out = false;
};

/// Runs the program under test. `watch` is called each time something was written, with the process, and with the
/// terminal, whose size it may change.
inline TerminalResult run_in_terminal(const std::vector<std::string>& arguments, const std::string& folder,
                                      const std::vector<std::string>& environment, TerminalScreen& screen, int columns,
                                      int rows, const std::function<void(pid_t child, int terminal)>& watch = {}) {
  const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (master < 0 || ::grantpt(master) != 0 || ::unlockpt(master) != 0) throw std::runtime_error("no terminal");
  const std::string name = ::ptsname(master);
  const int slave = ::open(name.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  winsize size{};
  size.ws_col = static_cast<unsigned short>(columns);
  size.ws_row = static_cast<unsigned short>(rows);
  ::ioctl(master, TIOCSWINSZ, &size);
  std::vector<std::string> words{ALHAZEN_BINARY};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> variables = environment;
  std::vector<char*> argv, envp;
  for (std::string& word : words) argv.push_back(word.data());
  for (std::string& variable : variables) envp.push_back(variable.data());
  argv.push_back(nullptr);
  envp.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    if (::chdir(folder.c_str()) != 0) ::_exit(127);
    const int nothing = ::open("/dev/null", O_RDWR);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(nothing, STDOUT_FILENO);
    ::dup2(slave, STDERR_FILENO);
    ::execve(argv[0], argv.data(), envp.data());
    ::_exit(127);
  }
  ::close(slave);
  TerminalResult result;
  const auto start = std::chrono::steady_clock::now();
  for (;;) {
    if (std::chrono::steady_clock::now() - start > std::chrono::seconds(120) && !result.timed_out) {
      result.timed_out = true;
      ::kill(child, SIGKILL);
    }
    pollfd ready{master, POLLIN, 0};
    if (::poll(&ready, 1, 50) <= 0) continue;
    char buffer[1 << 16];
    const ssize_t count = ::read(master, buffer, sizeof(buffer));
    if (count <= 0) break;  // EIO: nobody has it open any more
    result.text.append(buffer, static_cast<size_t>(count));
    screen.write(std::string(buffer, static_cast<size_t>(count)));
    if (watch) watch(child, master);
  }
  ::close(master);
  int status = 0;
  ::waitpid(child, &status, 0);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

}  // namespace alhazen::impl::test
