#pragma once

#include <cstddef>
#include <vector>

namespace quadrille::clocked {

/// First-in first-out memory with its head in a register, as the RTL's: a word becomes the head two edges after its
/// push. Who pushes knows that there is room. (Here the head stays where it is in the memory, which has a place more.)
template <class T>
class SyncFifo {
 public:
  explicit SyncFifo(std::size_t capacity) : slots_(capacity + 1) {}
  bool valid() const { return valid_; }
  bool empty() const { return count_ == 0 && !valid_; }
  const T& head() const { return slots_[first_]; }
  /// The head and the words behind it, those too that are not the head yet.
  std::size_t words() const { return count_ + (valid_ ? 1 : 0); }
  const T& word(std::size_t n) const { return slots_[wrapped(first_ + n)]; }
  /// Where the next word is written before it is pushed.
  T& next() { return slots_[wrapped(first_ + count_ + (valid_ ? 1 : 0))]; }
  /// The edge: the head leaves, the word in next() comes in.
  void clock(bool pop, bool push) {
    const bool load = count_ != 0 && (!valid_ || pop);
    if (valid_ && pop) first_ = wrapped(first_ + 1);
    valid_ = load || (valid_ && !pop);
    if (load) --count_;
    if (push) ++count_;
  }
  void clear() {
    first_ = count_ = 0;
    valid_ = false;
  }

 private:
  std::size_t wrapped(std::size_t place) const { return place < slots_.size() ? place : place - slots_.size(); }

  std::vector<T> slots_;
  std::size_t first_ = 0, count_ = 0;  ///< the head or the word that will be; the words behind the head
  bool valid_ = false;
};

}  // namespace quadrille::clocked
