#pragma once

// Included by the one source file of a module that defines it.

#include <alhazen_interface.h>

#include "util/module_identity.h"

/// Makes this shared object the module `NAME` with the function table `TABLE`.
#define ALHAZEN_MODULE(NAME, TABLE)                                                                         \
  extern "C" {                                                                                              \
  __attribute__((section(".alhazen"), used)) const ::alhazen::impl::ModuleIdentity alhazen_module_identity{ \
      "Alhazen module", NAME, ALHAZEN_VERSION, ALHAZEN_INTERFACE_HASH};                                     \
  const void* alhazen_module_functions();                                                                   \
  const void* alhazen_module_functions() { return &(TABLE); }                                               \
  }
