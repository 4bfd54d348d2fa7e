#include "model/support/parallel.hpp"

#ifndef QUADRILLE_NO_THREADS
#include <chrono>
#endif

namespace quadrille {

void run_units(std::size_t units, unsigned threads, const std::function<void(std::size_t, unsigned)>& body,
               const std::function<void(std::size_t)>& progress) {
  const auto all_here = [&] {
    for (std::size_t unit = 0; unit < units; ++unit) {
      body(unit, 0);
      if (progress) progress(unit + 1);
    }
  };
#ifdef QUADRILLE_NO_THREADS
  static_cast<void>(threads);
  all_here();
#else
  if (threads <= 1 || units <= 1) return all_here();
  std::mutex mutex;
  std::condition_variable changed;
  std::size_t next = 0, finished = 0, running = 0;
  bool stop = false;
  std::exception_ptr error;
  const auto fail = [&](std::exception_ptr e) {
    if (!error) error = e;
    stop = true;
  };

  std::vector<std::thread> workers;
  {
    std::unique_lock lock(mutex);  // nothing begins before all have been started
    start_threads(workers, std::min<std::size_t>(threads, units), [&](std::size_t thread) {
      std::unique_lock work(mutex);
      while (!stop && next < units) {
        const std::size_t unit = next++;
        work.unlock();
        std::exception_ptr thrown;
        try {
          body(unit, static_cast<unsigned>(thread));
        } catch (...) {
          thrown = std::current_exception();
        }
        work.lock();
        if (thrown) fail(thrown);
        ++finished;
      }
      if (--running == 0) changed.notify_one();
    });
    running = workers.size();
    if (running == 0) return all_here();
    while (running > 0) {
      changed.wait_for(lock, std::chrono::milliseconds(100), [&] { return running == 0; });
      if (!progress || stop) continue;
      const std::size_t done = finished;
      lock.unlock();
      std::exception_ptr thrown;
      try {
        progress(done);
      } catch (...) {
        thrown = std::current_exception();
      }
      lock.lock();
      if (thrown) fail(thrown);
    }
  }
  for (std::thread& worker : workers) worker.join();
  if (error) std::rethrow_exception(error);
#endif
}

}  // namespace quadrille
