#include "tb/sweep/synthesis.hpp"

#include "tb/yosys/yosys.hpp"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace quadrille::sweep {

std::vector<SynthesisRow> synthesise(std::span<const SynthesisPoint> points, const CostWeights& weights,
                                     unsigned threads,
                                     const std::function<void(std::size_t done, std::size_t total)>& progress) {
  std::vector<SynthesisRow> rows(points.size());
  std::mutex mutex;
  std::condition_variable changed;
  std::size_t next = 0, done = 0, running = std::min<std::size_t>(std::max(threads, 1u), points.size());
  std::exception_ptr failure;

  const auto work = [&] {
    std::unique_lock lock(mutex);
    while (next < points.size() && !failure) {
      const std::size_t index = next++;
      const SynthesisPoint& point = points[index];
      lock.unlock();
      std::exception_ptr error;
      try {
        const tb::FpgaReport report = tb::synthesise_fpga(point.config);
        rows[index] = {.row = point.row,
                       .luts = report.luts,
                       .flip_flops = report.flip_flops,
                       .dsps = report.dsps,
                       .longest_path = report.longest_path,
                       .cost = scalar_cost(hardware_cost(point.config), weights)};
      } catch (...) {
        error = std::current_exception();
      }
      lock.lock();
      ++done;
      if (error && !failure) failure = error;
      changed.notify_one();
    }
    --running;
    changed.notify_one();
  };
  std::vector<std::jthread> workers;
  for (std::size_t i = running; i > 0; --i) workers.emplace_back(work);

  std::unique_lock lock(mutex);
  for (std::size_t told = 0; running > 0 || told < done;) {
    changed.wait(lock, [&] { return running == 0 || told < done; });
    const std::size_t now = done;
    if (now == told) continue;
    told = now;
    if (!progress || failure) continue;
    lock.unlock();
    try {
      progress(now, points.size());
    } catch (...) {
      lock.lock();
      failure = std::current_exception();
      lock.unlock();
    }
    lock.lock();
  }
  lock.unlock();
  workers.clear();
  if (failure) std::rethrow_exception(failure);
  return rows;
}

}  // namespace quadrille::sweep
