#pragma once

// Long calls of the library: without the interpreter's lock (GIL), and ended by Ctrl-C.

#include <functional>

#include "bindings.h"

namespace alhazen::python {

class RunningCalls;

/// Releases the GIL for as long as it exists. At the end of the interpreter daemon threads must not take the GIL again:
/// Python would end them by unwinding, which ends the process where a destructor is on the way. They wait here for the
/// end of the process instead; the interpreter waits until all threads that are to take the GIL have it.
class Unlocked {
 public:
  Unlocked();
  ~Unlocked();
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  RunningCalls* calls_;  ///< that count it; those of another process in a child that it has forked
  PyThreadState* state_;
};

/// While one exists, its thread works for a call under way: it may take the GIL until that has ended.
class WithinCall {
 public:
  WithinCall();
  ~WithinCall();
  WithinCall(const WithinCall&) = delete;
  WithinCall& operator=(const WithinCall&) = delete;
};

/// Runs `call` without the GIL, and returns when it has ended; throws what it throws. Needs the GIL.
///
/// On the main thread, on which alone Python handles signals, `call` runs on a thread of its own, while this one runs
/// the handlers about twenty times a second. Once one of them raises, as that of Ctrl-C does, `stop` is called, without
/// the GIL; it should let `call` end soon, whatever it then throws. Then what the handler raised is thrown.
///
/// `stop` is also called, on some thread, when the interpreter ends while a daemon thread runs this.
void run_interruptible(const std::function<void()>& call, const std::function<void()>& stop);

/// Lets the interpreter wait at its end for what daemon threads render.
void bind_interrupts(py::module_& m);

}  // namespace alhazen::python
