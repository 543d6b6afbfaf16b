#include "alhazen/alhazen.h"

namespace alhazen::inline ALHAZEN_ABI_NAMESPACE {

const char* version() { return ALHAZEN_VERSION_STRING; }

}  // namespace alhazen::inline ALHAZEN_ABI_NAMESPACE
