/* Force-included when Verilator's run time is compiled: what it prints goes to device_glue.cpp, not to standard output.
 */
#pragma once
#ifdef __cplusplus
extern "C"
#endif
    int
    quadrille_device_print(const char* format, ...) __attribute__((format(printf, 1, 2)));
