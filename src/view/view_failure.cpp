#include "view/view_failure.h"

#include <exception>
#include <new>

#include "alhazen/error.h"

namespace alhazen::impl {

std::string text_of_error(ViewFailure* failure) {
  if (failure) *failure = ViewFailure::input;
  try {
    throw;
  } catch (const ::alhazen::InputError& error) {
    return error.what();
  } catch (const ::alhazen::UnsupportedError& error) {
    return error.what();
  } catch (const std::bad_alloc&) {
    if (failure) *failure = ViewFailure::other;
    return "alhazen: out of memory: the task needs more than this machine, or a limit set on it, allows";
  } catch (const std::exception& error) {
    if (failure) *failure = ViewFailure::other;
    return std::string("alhazen: ") + error.what();
  }
}

}  // namespace alhazen::impl
