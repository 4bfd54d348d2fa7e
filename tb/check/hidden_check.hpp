// What a machine that leaves hidden tiles out may leave out: fragments that the depth buffer would refuse.
#pragma once

#include "model/config.hpp"
#include "model/records.hpp"
#include "model/untimed.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace quadrille::cli {

/// Follows one draw, quad by quad, with a depth buffer (LESS, cleared at first) of what the machine drew.
class HiddenCheck {
 public:
  HiddenCheck(const Config& config, const DrawState& state);

  /// A fragment of the quad that is being drawn.
  void fragment(const Fragment& fragment);
  /// The quad is complete. Draws it once more with nothing hidden: what the machine drew must be there, in this order
  /// and bit by bit, and of what is missing nothing may be nearer than the buffer. Returns what is wrong first: the
  /// pixel and words.
  struct Fault {
    int x = 0, y = 0;
    std::string text;
  };
  std::optional<Fault> quad_done(const SnappedQuad& quad);

  /// Whether a depth within `tolerance` of z (both window z) may be refused by the buffer at the pixel.
  bool may_refuse(int x, int y, double z, double tolerance) const;
  /// Fragments that were left out so far.
  std::uint64_t left_out() const { return left_out_; }

 private:
  std::uint32_t& at(int x, int y) { return depth_[static_cast<std::size_t>(y * width_ + x)]; }

  int width_, height_, depth_bits_;
  UntimedModel everything_;
  std::vector<std::uint32_t> depth_;
  std::vector<Fragment> drawn_;
  std::uint64_t left_out_ = 0;
};

}  // namespace quadrille::cli
