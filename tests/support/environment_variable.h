#pragma once

// Sets an environment variable, also for the programs that a test runs.

#include <cstdlib>
#include <string>

namespace alhazen::impl::test {

/// The variable has the value as long as this lives, and none afterwards.
class EnvironmentVariable {
 public:
  EnvironmentVariable(const char* name, const std::string& value) : name_(name) { setenv(name, value.c_str(), 1); }
  ~EnvironmentVariable() { unsetenv(name_); }
  EnvironmentVariable(const EnvironmentVariable&) = delete;
  EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;

 private:
  const char* name_;
};

}  // namespace alhazen::impl::test
