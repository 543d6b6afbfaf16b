int alhazen_probe_answer();
int alhazen_probe_answer() { return 42; }
