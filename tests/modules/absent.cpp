// A library that another one is linked with, and that is absent where that one is loaded.

extern "C" int alhazen_absent() { return 1; }
