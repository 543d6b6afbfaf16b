#include "alhazen/alhazen.h"

namespace ALHAZEN_NAMESPACE {

const char* version() { return ALHAZEN_VERSION_STRING; }

}  // namespace ALHAZEN_NAMESPACE
