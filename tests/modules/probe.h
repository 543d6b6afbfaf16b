#pragma once

// The interface of the module that the tests load.

namespace alhazen::impl::test {

struct ProbeModule {
  int answer;
  /// The address of an object of the library, as the module sees it.
  const void* (*library_state)();
};

}  // namespace alhazen::impl::test
