// What drives the machine's inputs: vertex beats with gaps, and the ready of its output with stalls, at random or
// listed.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"
#include "model/support/prng.hpp"
#include "tb/lockstep/wait_pattern.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace quadrille::tb {

/// Offers the vertices of a list of quads, four beats each. A beat, once offered, stays until it is taken; before each
/// one valid is low for a random number of clocks, each with probability `gap`, or for those listed. What the machine
/// must not look at is rubbish on purpose: the payload while valid is low; ids, bases and depth limits of the beats v1
/// to v3 (a quad's are v0's); the attributes of v0; attributes and their bases in slots that are not in use. Attributes
/// are then numbers of any sign and exponent, bases any code.
class VertexDriver {
 public:
  /// `attributes`: slots in use. `listed`: PortWaits::gap_beats, which must outlive it, in the place of `gap`; those
  /// that the chance would have drawn give the same signals bit by bit, rubbish included. Throws std::invalid_argument
  /// for a gap outside [0, 1), both, a list that does not ascend or a quad id that does not fit the port. A `pattern`
  /// of another kind draws the waits in the place of `gap`.
  VertexDriver(std::span<const SnappedQuad> quads, const Config& config, int attributes, std::uint64_t seed, double gap,
               std::span<const std::uint64_t> listed = {}, WaitKind pattern = WaitKind::chance);

  bool done() const { return next_ == 4 * quads_.size(); }
  bool valid() const { return valid_; }
  /// The beat on offer, when valid.
  const VertexBeat& beat() const { return beat_; }
  /// The packed beat (or the rubbish); `changed` tells whether it is new in this clock.
  std::span<const std::uint32_t> words() const { return words_; }
  bool changed() const { return changed_; }
  std::uint64_t beats_taken() const { return next_; }
  double fraction() const {
    return quads_.empty() ? 1.0 : static_cast<double>(next_) / static_cast<double>(4 * quads_.size());
  }

  /// After the clock edge; `taken`: the beat on offer was accepted by it. `flush`: beats of its quad are gone, and the
  /// next on offer is the quad's first.
  void advance(bool taken, bool flush = false);

 private:
  bool waits();
  void offer();
  void scramble();
  PortNumber any_number();
  std::int64_t any_code(int bits);

  std::span<const SnappedQuad> quads_;
  const Config& config_;
  int attributes_;
  golden::Prng random_;
  golden::Prng rubbish_;  ///< inside a beat; apart from random_, so that the gaps depend on the seed alone
  double gap_;
  WaitKind kind_;
  WaitPattern pattern_;
  std::span<const std::uint64_t> listed_;
  std::size_t next_listed_ = 0;
  int width_;
  std::size_t next_ = 0;
  bool valid_ = false, changed_ = true;
  VertexBeat beat_;
  std::vector<std::uint64_t> packed_;
  std::vector<std::uint32_t> words_;
};

/// An input that is high in each clock with a probability of its own.
class PulseDriver {
 public:
  /// Throws std::invalid_argument for a chance outside [0, 1), which `name` has.
  PulseDriver(std::uint64_t seed, std::uint64_t stream, double chance, const char* name);
  bool high() const { return high_; }
  void advance() { high_ = chance_ != 0 && random_.chance(chance_); }

 private:
  golden::Prng random_;
  double chance_;
  bool high_ = false;
};

/// fragment_ready_i, low in each clock with probability `stall`, or in those listed.
class ReadyDriver {
 public:
  /// `listed`: PortWaits::stall_clocks, which must outlive it, in the place of `stall`. Throws std::invalid_argument
  /// for a stall outside [0, 1), both, or a list that does not ascend.
  ReadyDriver(std::uint64_t seed, double stall, std::span<const std::uint64_t> listed = {},
              WaitKind pattern = WaitKind::chance);
  bool ready() const { return ready_; }
  void advance() {
    const bool low = kind_ != WaitKind::chance ? pattern_.next()
                     : listed_.empty()         ? stall_ != 0 && random_.chance(stall_)
                                               : next_listed_ < listed_.size() && listed_[next_listed_] == clock_;
    next_listed_ += low ? 1 : 0;
    ++clock_;
    ready_ = !low;
  }

 private:
  golden::Prng random_;
  double stall_;
  WaitKind kind_;
  WaitPattern pattern_;
  std::span<const std::uint64_t> listed_;
  std::size_t next_listed_ = 0;
  std::uint64_t clock_ = 0;  ///< that comes next
  bool ready_ = true;
};

}  // namespace quadrille::tb
