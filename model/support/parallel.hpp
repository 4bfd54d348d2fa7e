// Work in numbered units on several threads. In both forms what comes out does not depend on the number of threads,
// provided that a unit's result depends on its number alone; the calling thread returns when no unit is running; with
// one thread or one unit everything happens on the calling thread. Where the system refuses threads, those that it
// gave do the work, or the calling thread. WebAssembly has none: everything happens on the calling thread.
#pragma once

#ifdef __wasm__
#define QUADRILLE_NO_THREADS
#endif

#include <cstddef>
#include <functional>
#ifndef QUADRILLE_NO_THREADS
#include <algorithm>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>
#endif

namespace quadrille {

#ifndef QUADRILLE_NO_THREADS
/// Up to `count` threads that run work(i), i from 0: fewer, or none, when the system refuses more. Those that run are
/// in `threads`, also when this throws.
template <class Work>
void start_threads(std::vector<std::thread>& threads, std::size_t count, const Work& work) {
  threads.reserve(threads.size() + count);
  for (std::size_t i = 0; i < count; ++i) try {
      threads.emplace_back(work, i);
    } catch (const std::exception&) {  // a limit of threads or of memory
      return;
    }
}
#endif

/// Calls body(unit, thread) for every unit from 0; thread is below max(threads, 1) and no two calls of one thread
/// overlap. `progress` (may be empty) gets the number of finished units on the calling thread now and then. The first
/// exception, from either, ends the call after the running units and is rethrown.
void run_units(std::size_t units, unsigned threads, const std::function<void(std::size_t, unsigned)>& body,
               const std::function<void(std::size_t)>& progress = {});

/// Calls produce(unit) for unit = 0 … units-1 on `threads` threads and consume(unit, result) in order on the calling
/// thread. At most a few results per thread wait. The exception of the lowest unit that threw is rethrown; later
/// results are dropped.
template <class Produce, class Consume>
void ordered_parallel(std::size_t units, unsigned threads, Produce&& produce, Consume&& consume) {
  const auto all_here = [&] {
    for (std::size_t unit = 0; unit < units; ++unit) consume(unit, produce(unit));
  };
#ifdef QUADRILLE_NO_THREADS
  static_cast<void>(threads);
  all_here();
#else
  if (threads <= 1 || units <= 1) return all_here();
  using Result = decltype(produce(std::size_t{0}));
  struct Slot {
    std::optional<Result> result;
    std::exception_ptr error;
  };
  std::mutex mutex;
  std::condition_variable room, ready;
  std::map<std::size_t, Slot> waiting;
  std::size_t next = 0, consumed = 0;
  bool stop = false;
  const std::size_t window = std::size_t{4} * threads;

  const auto work = [&](std::size_t /*thread*/) {
    for (;;) {
      std::size_t unit;
      {
        std::unique_lock lock(mutex);
        room.wait(lock, [&] { return stop || next >= units || next < consumed + window; });
        if (stop || next >= units) return;
        unit = next++;
      }
      Slot slot;
      try {
        slot.result.emplace(produce(unit));
      } catch (...) {
        slot.error = std::current_exception();
      }
      std::lock_guard lock(mutex);
      waiting.emplace(unit, std::move(slot));
      ready.notify_one();
    }
  };
  struct Joiner {
    std::vector<std::thread> threads;
    std::mutex& mutex;
    std::condition_variable& room;
    bool& stop;
    ~Joiner() {
      {
        std::lock_guard lock(mutex);
        stop = true;
      }
      room.notify_all();
      for (std::thread& thread : threads) thread.join();
    }
  } joiner{{}, mutex, room, stop};
  start_threads(joiner.threads, std::min<std::size_t>(threads, units), work);
  if (joiner.threads.empty()) return all_here();

  for (std::size_t unit = 0; unit < units; ++unit) {
    Slot slot;
    {
      std::unique_lock lock(mutex);
      ready.wait(lock, [&] { return waiting.contains(unit); });
      slot = std::move(waiting.at(unit));
      waiting.erase(unit);
      consumed = unit + 1;
    }
    room.notify_all();
    if (slot.error) std::rethrow_exception(slot.error);
    consume(unit, std::move(*slot.result));
  }
#endif
}

/// run_units() for a body that does not care which thread it is on.
template <class Body>
void parallel_for(std::size_t units, unsigned threads, Body&& body) {
  run_units(units, threads, [&](std::size_t unit, unsigned) { body(unit); });
}

}  // namespace quadrille
