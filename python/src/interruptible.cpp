#include "interruptible.h"

#include <pythread.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <list>
#include <mutex>
#include <thread>

namespace alhazen::python {

namespace {

/// The calls under way, by what stops them.
class RunningCalls {
 public:
  using Entry = std::list<const std::function<void()>*>::iterator;

  /// Throws once the interpreter ends.
  Entry add(const std::function<void()>& stop) {
    const std::lock_guard lock(mutex_);
    if (is_over_) throw alhazen_is_over();
    return stops_.insert(stops_.end(), &stop);
  }

  void remove(Entry entry) {
    const std::lock_guard lock(mutex_);
    stops_.erase(entry);
    ended_.notify_all();
  }

  /// Stops all and waits until they have ended. Without the GIL, which they need to end.
  void stop_all() {
    std::unique_lock lock(mutex_);
    is_over_ = true;
    for (const std::function<void()>* stop : stops_) (*stop)();
    ended_.wait(lock, [this] { return stops_.empty(); });
  }

 private:
  static py::error_already_set alhazen_is_over() {
    PyErr_SetString(PyExc_RuntimeError, "the interpreter is shutting down");
    return {};
  }

  std::mutex mutex_;
  std::condition_variable ended_;
  std::list<const std::function<void()>*> stops_;
  bool is_over_ = false;
};

/// Never destroyed: daemon threads may outlive static objects.
RunningCalls& running_calls() {
  static auto* const calls = new RunningCalls;
  return *calls;
}

class RunningCall {
 public:
  explicit RunningCall(const std::function<void()>& stop) : entry_(running_calls().add(stop)) {}
  ~RunningCall() { running_calls().remove(entry_); }
  RunningCall(const RunningCall&) = delete;
  RunningCall& operator=(const RunningCall&) = delete;

 private:
  RunningCalls::Entry entry_;
};

bool is_main_thread() {
  const py::object main = py::module_::import("threading").attr("main_thread")().attr("ident");
  return !main.is_none() && py::cast<unsigned long>(main) == PyThread_get_thread_ident();
}

/// What a signal handler raises, if one does; null otherwise.
std::exception_ptr run_signal_handlers() {
  const py::gil_scoped_acquire locked;
  if (PyErr_CheckSignals() == 0) return nullptr;
  return std::make_exception_ptr(py::error_already_set());
}

/// Far less than the 0.2 seconds in which a person expects Ctrl-C to act; each look takes microseconds.
constexpr std::chrono::milliseconds time_between_looks{50};

void run_beside_signals(const std::function<void()>& call, const std::function<void()>& stop) {
  std::mutex mutex;
  std::condition_variable ended;
  bool has_ended = false;
  std::exception_ptr failure, raised;
  {
    const py::gil_scoped_release unlocked;
    std::thread thread([&] {
      try {
        call();
      } catch (...) {
        failure = std::current_exception();
      }
      const std::lock_guard lock(mutex);
      has_ended = true;
      ended.notify_one();
    });
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, time_between_looks, [&] { return has_ended; })) {
      if (raised) continue;
      lock.unlock();
      raised = run_signal_handlers();
      if (raised) stop();
      lock.lock();
    }
    lock.unlock();
    thread.join();
  }
  if (raised) std::rethrow_exception(raised);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

void run_interruptible(const std::function<void()>& call, const std::function<void()>& stop) {
  const RunningCall running(stop);
  if (is_main_thread()) {
    run_beside_signals(call, stop);
  } else {
    const py::gil_scoped_release unlocked;
    call();
  }
}

void bind_interrupts(py::module_&) {
  py::module_::import("atexit").attr("register")(py::cpp_function([] {
    const py::gil_scoped_release unlocked;
    running_calls().stop_all();
  }));
}

}  // namespace alhazen::python
