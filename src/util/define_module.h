#pragma once

// For the one file of a module that declares it.

#include <alhazen_interface.h>

#include "util/module_identity.h"

/// Makes the shared object that this is compiled into the module `NAME`, which hands out the table `TABLE`.
#define ALHAZEN_MODULE(NAME, TABLE)                                                                   \
  extern "C" {                                                                                        \
  __attribute__((section(".alhazen"), used)) const ::alhazen::ModuleIdentity alhazen_module_identity{ \
      "Alhazen module", NAME, ALHAZEN_VERSION, ALHAZEN_INTERFACE_HASH};                               \
  const void* alhazen_module_functions();                                                             \
  const void* alhazen_module_functions() { return &(TABLE); }                                         \
  }
