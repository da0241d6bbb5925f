/* The copy of AsmJit's archive in the module asks for this name instead of stderr (python/CMakeLists.txt). */
#include <stdio.h>

__attribute__((visibility("hidden"))) FILE* hamflow_asmjit_stderr;

__attribute__((constructor)) static void begin(void) { hamflow_asmjit_stderr = stderr; }
