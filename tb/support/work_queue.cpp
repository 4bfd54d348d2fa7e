#include "tb/support/work_queue.hpp"

#include "model/support/parallel.hpp"

#include <utility>

namespace quadrille::tb {

WorkQueue::WorkQueue(unsigned threads, std::size_t capacity) : capacity_(capacity) {
  start_threads(threads_, threads, [this](std::size_t) { work(); });
}

WorkQueue::~WorkQueue() {
  {
    std::lock_guard lock(mutex_);
    stop_ = true;
    jobs_.clear();
  }
  more_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void WorkQueue::run(Job& job) {
  try {
    job();
  } catch (...) {
    std::lock_guard lock(mutex_);
    if (!error_) error_ = std::current_exception();
  }
}

void WorkQueue::push(Job job) {
  if (!threads_.empty()) {
    std::lock_guard lock(mutex_);
    if (jobs_.size() < capacity_) {
      jobs_.push_back(std::move(job));
      more_.notify_one();
      return;
    }
  }
  run(job);
}

void WorkQueue::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    more_.wait(lock, [&] { return stop_ || !jobs_.empty(); });
    if (stop_) return;
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    ++running_;
    lock.unlock();
    run(job);
    lock.lock();
    --running_;
    idle_.notify_all();
  }
}

void WorkQueue::drain() {
  std::unique_lock lock(mutex_);
  while (!jobs_.empty()) {
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    run(job);
    lock.lock();
  }
  idle_.wait(lock, [&] { return running_ == 0; });
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

}  // namespace quadrille::tb
