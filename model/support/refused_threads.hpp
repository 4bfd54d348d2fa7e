// For tests: a process that gets no more than a number of threads. Included once in a program: its pthread_create comes
// before the C library's, also for the C++ library's std::thread.
#pragma once

#include <dlfcn.h>
#include <pthread.h>
#include <atomic>
#include <cerrno>

namespace quadrille {

/// Threads that may still be made; negative: any number.
inline std::atomic<int> threads_left = -1;
/// Those that were refused.
inline std::atomic<int> threads_refused = 0;

/// Refuses threads after the first `count` until it is gone.
class ThreadLimit {
 public:
  explicit ThreadLimit(int count) {
    threads_left = count;
    threads_refused = 0;
  }
  ~ThreadLimit() { threads_left = -1; }
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

  int refused() const { return threads_refused; }
};

}  // namespace quadrille

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                              void* argument) noexcept {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  if (quadrille::threads_left >= 0 && --quadrille::threads_left < 0) {
    quadrille::threads_left = 0;
    ++quadrille::threads_refused;
    return EAGAIN;
  }
  return create(thread, attributes, start, argument);
}
