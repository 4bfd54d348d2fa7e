// A bounded queue of jobs for reference threads. When it is full, or without threads (none wanted, or the system
// refuses them), the one who pushes does the job.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace quadrille::tb {

class WorkQueue {
 public:
  using Job = std::function<void()>;

  WorkQueue(unsigned threads, std::size_t capacity);
  ~WorkQueue();
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;

  void push(Job job);
  /// Helps until nothing is left or running; rethrows what a job threw.
  void drain();

 private:
  void work();
  void run(Job& job);

  std::size_t capacity_;
  std::mutex mutex_;
  std::condition_variable more_, idle_;
  std::deque<Job> jobs_;
  std::size_t running_ = 0;
  bool stop_ = false;
  std::exception_ptr error_;
  std::vector<std::thread> threads_;
};

}  // namespace quadrille::tb
