#include "tb/lockstep/driver.hpp"

#include "model/port/bit_vector.hpp"
#include "model/port/stages.hpp"

#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

namespace quadrille::tb {

namespace {

double probability(double value, const char* name) {
  if (!(value >= 0 && value < 1)) {
    throw std::invalid_argument(std::string(name) + " must be at least 0 and below 1, not " + std::to_string(value));
  }
  return value;
}

/// Waits at random and listed ones at a time would leave open which of them a list was recorded from.
std::span<const std::uint64_t> checked_list(std::span<const std::uint64_t> listed, double chance, const char* name,
                                            bool repeats) {
  if (!listed.empty() && chance != 0) throw std::invalid_argument(std::string(name) + " both at random and listed");
  for (std::size_t i = 1; i < listed.size(); ++i)
    if (listed[i] < listed[i - 1] || (!repeats && listed[i] == listed[i - 1]))
      throw std::invalid_argument(std::string(name) + " listed out of order");
  return listed;
}

}  // namespace

VertexDriver::VertexDriver(std::span<const SnappedQuad> quads, const Config& config, int attributes, std::uint64_t seed,
                           double gap, std::span<const std::uint64_t> listed, WaitKind pattern)
    : quads_(quads),
      config_(config),
      attributes_(attributes),
      random_(seed, 1),
      rubbish_(seed, 4),
      gap_(probability(gap, "gap")),
      kind_(listed.empty() ? pattern : WaitKind::chance),
      pattern_(pattern, WaitPattern::Port::input, seed),
      listed_(checked_list(listed, gap, "gap", true)),
      width_(vertex_layout(config).bits()),
      packed_(static_cast<std::size_t>((width_ + 63) / 64)),
      words_(words_for(width_)) {
  for (const SnappedQuad& quad : quads) {
    if (config.quad_id_bits < 32 && quad.id >> config.quad_id_bits != 0) {
      throw std::invalid_argument("quad id " + std::to_string(quad.id) +
                                  " does not fit quad_id_bits = " + std::to_string(config.quad_id_bits));
    }
  }
  offer();
}

bool VertexDriver::waits() {
  if (listed_.empty() && kind_ == WaitKind::chance) return gap_ > 0 && random_.chance(gap_);
  random_.uniform();  // as the chance would: the rubbish that follows is that of the run with chances
  if (kind_ != WaitKind::chance) return pattern_.next();
  if (next_listed_ == listed_.size() || listed_[next_listed_] != next_) return false;
  ++next_listed_;
  return true;
}

void VertexDriver::offer() {
  if (done() || waits()) {
    valid_ = false;
    scramble();
    return;
  }
  valid_ = true;
  changed_ = true;
  const SnappedQuad& quad = quads_[next_ / 4];
  const std::size_t beat = next_ % 4, slots = static_cast<std::size_t>(config_.attribute_slots),
                    used = static_cast<std::size_t>(attributes_);
  beat_ = beat_of(quad, beat);
  if (beat != 0) {
    beat_.id ^= static_cast<std::uint32_t>(1 + rubbish_.below((std::uint64_t{1} << config_.quad_id_bits) - 1));
    const int depth = config_.depth_bits;
    beat_.base.depth = static_cast<std::uint32_t>(rubbish_.below(std::uint64_t{2} << depth));
    beat_.base.depth_low = static_cast<std::int32_t>(any_code(depth + 2));
    beat_.base.depth_high = static_cast<std::int32_t>(any_code(depth + 2));
  }
  for (std::size_t slot = beat == 0 ? used : 0; slot < slots; ++slot)
    beat_.base.attribute[slot] = any_code(config_.attr_out_bits());
  for (std::size_t slot = beat == 0 ? 0 : used; slot < slots; ++slot) beat_.vertex.attribute[slot] = any_number();
  BitPacker packer(packed_.data(), width_);
  visit(std::as_const(beat_), config_, packer);
  packer.finish();
  std::memcpy(words_.data(), packed_.data(), words_.size() * sizeof(std::uint32_t));
}

void VertexDriver::scramble() {
  for (std::uint32_t& word : words_) word = static_cast<std::uint32_t>(random_.next());
  if (width_ % 32 != 0) words_.back() &= (std::uint32_t{1} << (width_ % 32)) - 1;
  changed_ = true;
}

PortNumber VertexDriver::any_number() {
  constexpr int exp_limit = 1 << (Config::port_exp_bits - 1);
  const std::uint32_t leading = std::uint32_t{1} << (config_.significand_bits - 1);
  PortNumber number;
  number.neg = rubbish_.chance(0.5);
  number.exp = static_cast<std::int32_t>(rubbish_.integer(-exp_limit, exp_limit - 1));
  number.sig = leading | static_cast<std::uint32_t>(rubbish_.below(leading));
  return number;
}

std::int64_t VertexDriver::any_code(int bits) {
  const std::int64_t limit = std::int64_t{1} << (bits - 1);
  return rubbish_.integer(-limit, limit - 1);
}

void VertexDriver::advance(bool taken, bool flush) {
  changed_ = false;
  if (flush && (taken || next_ % 4 != 0)) {
    next_ -= next_ % 4;
    offer();
    return;
  }
  if (valid_ && !taken) return;
  if (taken) ++next_;
  if (done() && !valid_) return;  // idle after the last beat: the rubbish stays
  offer();
}

PulseDriver::PulseDriver(std::uint64_t seed, std::uint64_t stream, double chance, const char* name)
    : random_(seed, stream), chance_(probability(chance, name)) {
  advance();
}

ReadyDriver::ReadyDriver(std::uint64_t seed, double stall, std::span<const std::uint64_t> listed, WaitKind pattern)
    : random_(seed, 2),
      stall_(probability(stall, "stall")),
      kind_(listed.empty() ? pattern : WaitKind::chance),
      pattern_(pattern, WaitPattern::Port::output, seed),
      listed_(checked_list(listed, stall, "stall", false)) {
  advance();
}

}  // namespace quadrille::tb
