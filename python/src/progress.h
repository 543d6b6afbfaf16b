#pragma once

// Functions of Python that the library calls back while it renders.

#include <atomic>
#include <functional>
#include <memory>
#include <vector>

#include "alhazen/alhazen.h"
#include "bindings.h"

namespace alhazen::python {

/// What `progress` throws to end a render that is to be dropped.
struct RenderDropped {};

/// An object of Python that threads without the GIL may hold, copy and drop.
std::shared_ptr<py::object> shared_object(py::object object);

/// Whether a callback's result says to stop: False does, of Python or NumPy, and None and all else do not.
bool says_stop(const py::object& result);

/// The ProgressFunction for the argument `progress`: a callable, True for an alhazen.ProgressBar, or None or False. It
/// throws RenderDropped once `is_dropped`, and what the callable raises as error_already_set. Needs the GIL.
ProgressFunction progress_function(const py::object& progress, std::shared_ptr<const std::atomic<bool>> is_dropped);

/// Runs a call that reads or builds, and gives it a progress function, without the GIL; Ctrl-C ends it.
void run_droppable(const std::function<void(const ProgressFunction&)>& call);

void bind_progress(py::module_& m);

}  // namespace alhazen::python
