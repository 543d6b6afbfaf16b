#pragma once

// The thread that may take its time: it answers requests for what is below the page, one after another.

#include <condition_variable>
#include <csignal>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace alhazen::impl {

class GetThread {
 public:
  GetThread();
  /// Waits for a job that is running, and drops the others.
  ~GetThread();
  GetThread(const GetThread&) = delete;
  GetThread& operator=(const GetThread&) = delete;

  /// From any thread. Jobs throw nothing.
  void add(std::function<void()> job);

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> jobs_;
  bool is_ending_ = false;
  std::thread thread_;
};

/// While one exists, threads that the calling one starts receive no signals, so that those that interrupt waiting
/// reach the threads of the program that wait for them.
class WithoutSignals {
 public:
  WithoutSignals();
  ~WithoutSignals();
  WithoutSignals(const WithoutSignals&) = delete;
  WithoutSignals& operator=(const WithoutSignals&) = delete;

 private:
  sigset_t before_;
};

}  // namespace alhazen::impl
