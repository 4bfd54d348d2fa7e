/* Force-included when Verilator's FST writer is compiled. The writer looks at no result: it maps files that a full disk
 * left too short and dies by SIGBUS, and it calls a file that was cut off written. With these in place of the two
 * functions a map always has memory behind it, and what went wrong is kept for device_glue.cpp. */
#pragma once

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <sys/mman.h>

/* errno of the first failure of the waveform that this thread writes; 0: none. */
extern "C" __attribute__((visibility("hidden"))) thread_local int quadrille_trace_error;

static inline void quadrille_trace_failed(int error) {
  if (quadrille_trace_error == 0) quadrille_trace_error = error != 0 ? error : EIO;
}

static inline void* quadrille_trace_mmap(void* where, size_t length, int protection, int flags, int file,
                                         off_t offset) {
  const int error = posix_fallocate(file, offset, (off_t)length);
  if (error == 0) return mmap(where, length, protection, flags, file, offset);
  quadrille_trace_failed(error);
  return mmap(where, length, protection, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
}

static inline int quadrille_trace_fflush(FILE* file) {
  const int result = fflush(file);
  if (result != 0) quadrille_trace_failed(errno);
  return result;
}

static inline int quadrille_trace_fclose(FILE* file) {
  if (ferror(file)) quadrille_trace_failed(0);
  const int result = fclose(file);
  if (result != 0) quadrille_trace_failed(errno);
  return result;
}

#define mmap quadrille_trace_mmap
#define fflush quadrille_trace_fflush
#define fclose quadrille_trace_fclose
