#include "alhazen/alhazen.h"

namespace alhazen {

const char* version() { return ALHAZEN_VERSION; }

}  // namespace alhazen
