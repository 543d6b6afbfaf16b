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

/// How many calls under way this thread works for.
thread_local int calls_of_thread = 0;

}  // namespace

WithinCall::WithinCall() { ++calls_of_thread; }
WithinCall::~WithinCall() { --calls_of_thread; }

/// The calls under way, by what stops them, and the threads that work without the GIL.
class RunningCalls {
 public:
  using Entry = std::list<const std::function<void()>*>::iterator;

  /// Without the GIL. Once the interpreter ends, it returns only to what a call under way has called back.
  Entry add(const std::function<void()>& stop) {
    std::unique_lock lock(mutex_);
    if (is_over_ && may_wait()) wait_for_the_end(lock);
    return stops_.insert(stops_.end(), &stop);
  }

  /// Needs no GIL.
  void remove(Entry entry) {
    const std::lock_guard lock(mutex_);
    stops_.erase(entry);
    changed_.notify_all();
  }

  /// Before a thread releases the GIL.
  void begin_unlocked() {
    const std::lock_guard lock(mutex_);
    ++unlocked_;
  }

  /// Before it takes the GIL again, without it: does not return once the interpreter ends, unless a call is still to
  /// end that needs this thread.
  void wait_where_over() {
    std::unique_lock lock(mutex_);
    if (is_over_ && may_wait()) wait_for_the_end(lock);
  }

  /// Once it has the GIL.
  void end_unlocked() {
    const std::lock_guard lock(mutex_);
    --unlocked_;
    changed_.notify_all();
  }

  /// Stops all calls, and waits until they have ended and no other thread is about to take the GIL. Without the GIL.
  void stop_all() {
    std::unique_lock lock(mutex_);
    is_over_ = true;
    ending_ = std::this_thread::get_id();
    for (const std::function<void()>* stop : stops_) (*stop)();
    changed_.wait(lock, [this] { return stops_.empty() && unlocked_ == 0; });
  }

 private:
  bool may_wait() const { return calls_of_thread == 0 && std::this_thread::get_id() != ending_; }

  /// Of the process.
  void wait_for_the_end(std::unique_lock<std::mutex>& lock) {
    --unlocked_;
    changed_.notify_all();
    never_.wait(lock, [] { return false; });
  }

  std::mutex mutex_;
  std::condition_variable changed_, never_;
  std::list<const std::function<void()>*> stops_;
  int unlocked_ = 0;
  bool is_over_ = false;
  std::thread::id ending_;  ///< the thread that ends the interpreter
};

namespace {

/// Never destroyed: daemon threads may outlive static objects.
RunningCalls*& calls_of_process() {
  static auto* calls = new RunningCalls;
  return calls;
}
RunningCalls& running_calls() { return *calls_of_process(); }

/// False in a child that was forked by a function that a call has called back.
bool is_of_this_process(const RunningCalls* calls) { return calls == calls_of_process(); }

class RunningCall {
 public:
  explicit RunningCall(const std::function<void()>& stop) : calls_(&running_calls()), entry_(calls_->add(stop)) {}
  ~RunningCall() {
    if (is_of_this_process(calls_)) calls_->remove(entry_);
  }
  RunningCall(const RunningCall&) = delete;
  RunningCall& operator=(const RunningCall&) = delete;

 private:
  RunningCalls* calls_;
  RunningCalls::Entry entry_;
  WithinCall within_;
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
    const Unlocked unlocked;
    const RunningCall running(stop);
    std::thread thread([&] {
      const WithinCall within;
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

Unlocked::Unlocked() : calls_(&running_calls()) {
  calls_->begin_unlocked();
  state_ = PyEval_SaveThread();
}

Unlocked::~Unlocked() {
  if (is_of_this_process(calls_)) calls_->wait_where_over();
  PyEval_RestoreThread(state_);
  if (is_of_this_process(calls_)) calls_->end_unlocked();
}

void run_interruptible(const std::function<void()>& call, const std::function<void()>& stop) {
  if (is_main_thread()) {
    run_beside_signals(call, stop);
  } else {
    const Unlocked unlocked;
    const RunningCall running(stop);
    call();
  }
}

void bind_interrupts(py::module_&) {
  py::module_::import("atexit").attr("register")(py::cpp_function([] {
    const py::gil_scoped_release unlocked;
    running_calls().stop_all();
  }));
  // Other threads, which may hold its mutex, are not in the child.
  py::module_::import("os").attr("register_at_fork")(
      py::arg("after_in_child") = py::cpp_function([] { calls_of_process() = new RunningCalls; }));
}

}  // namespace alhazen::python
