// Random numbers that can be drawn again with some of them changed: whoever draws shapes from them moves within the
// shapes that the same code can draw.
#pragma once

#include "model/support/prng.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace quadrille::golden {

/// Either a Prng as it is, or given words first, then those of a Prng, and all that were taken kept.
class RecordedNumbers : public RandomNumbers<RecordedNumbers> {
 public:
  explicit RecordedNumbers(std::uint64_t seed) : source_(seed) {}
  RecordedNumbers(std::uint64_t seed, std::vector<std::uint64_t> words)
      : source_(seed), recorded_(true), words_(std::move(words)) {}

  std::uint64_t next() {
    if (!recorded_) return source_.next();
    if (position_ == words_.size()) words_.push_back(source_.next());
    return words_[position_++];
  }

  /// Words taken so far, less those forgotten; 0 when none are kept.
  std::size_t position() const { return position_; }
  /// As if the words from position `begin` to `end` had never been taken.
  void forget(std::size_t begin, std::size_t end) {
    const auto at = [this](std::size_t i) { return words_.begin() + static_cast<std::ptrdiff_t>(i); };
    words_.erase(at(begin), at(end));
    position_ -= end - begin;
  }
  /// Those that were taken.
  std::vector<std::uint64_t> take_words() {
    words_.resize(position_);
    return std::move(words_);
  }

 private:
  Prng source_;
  bool recorded_ = false;
  std::vector<std::uint64_t> words_;
  std::size_t position_ = 0;
};

}  // namespace quadrille::golden
