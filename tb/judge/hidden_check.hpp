// What a machine that leaves hidden tiles out may leave out: fragments that the depth buffer would refuse.
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"
#include "model/untimed.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace quadrille::tb {

/// The codes in a depth buffer (LESS) of what a machine drew since a clear.
class HiddenDepths {
 public:
  HiddenDepths(int width, int height)
      : codes_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), nothing), width_(width) {}
  void clear() { codes_.assign(codes_.size(), nothing); }
  std::uint32_t& at(int x, int y) { return codes_[static_cast<std::size_t>(y * width_ + x)]; }
  std::uint32_t at(int x, int y) const { return codes_[static_cast<std::size_t>(y * width_ + x)]; }

  static constexpr std::uint32_t nothing = ~std::uint32_t{0};

 private:
  std::vector<std::uint32_t> codes_;
  int width_;
};

/// Follows one draw, quad by quad, with a depth buffer of what the machine drew.
class HiddenCheck {
 public:
  /// `before`: what earlier draws left in the depth buffer, which goes on and must outlive this; null: nothing.
  /// `exact`: the machine has the model's bits.
  HiddenCheck(const Config& config, const DrawState& state, HiddenDepths* before = nullptr, bool exact = true);

  /// A fragment of the quad that is being drawn.
  void fragment(const Fragment& fragment);
  /// The quad is complete. Where the machine is exact, draws it once more with nothing hidden: what the machine drew
  /// must be there, in this order and bit by bit, and of what is missing nothing may be nearer than the buffer. Returns
  /// what is wrong first: the pixel and words.
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
  int width_, height_, depth_bits_;
  bool exact_;
  UntimedModel everything_;
  HiddenDepths own_;
  HiddenDepths& depth_;
  std::vector<Fragment> drawn_;
  std::uint64_t left_out_ = 0;
};

}  // namespace quadrille::tb
