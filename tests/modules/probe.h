#pragma once

// What the module of the tests hands out.

namespace alhazen::test {

struct ProbeModule {
  int answer;
  /// The address of an object of the library, as the module sees it.
  const void* (*library_state)();
};

}  // namespace alhazen::test
