// What the tests of hierarchical z share.
#pragma once

#include "model/skips/hidden_blocks.hpp"
#include "model/skips/hierarchical_z.hpp"
#include "model/skips/masked_depth.hpp"
#include "model/support/prng.hpp"
#include "model/untimed.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace quadrille {
namespace {

using golden::Prng;

inline Config configured(std::initializer_list<std::pair<const char*, int>> values = {}) {
  Config config;
  config.set("hierarchical_z_bits", 12);
  for (const auto& [key, value] : values) config.set(key, value);
  config.validate();
  return config;
}

/// A frame buffer with depth test LESS that a fragment's every bit goes into.
class Picture {
 public:
  Picture(const Config& config, int width, int height)
      : config_(config), width_(width), pixel_(static_cast<std::size_t>(width * height)) {}

  void add(const Fragment& f) {
    std::optional<Fragment>& place = pixel_[static_cast<std::size_t>(f.y * width_ + f.x)];
    const std::uint32_t clear = 1u << config_.depth_bits;
    if (f.depth < (place ? place->depth : clear)) place = f;
  }
  void clear() { std::ranges::fill(pixel_, std::nullopt); }
  std::size_t covered() const {
    return static_cast<std::size_t>(std::ranges::count_if(pixel_, [](const auto& p) { return p.has_value(); }));
  }

  friend bool operator==(const Picture& a, const Picture& b) { return a.pixel_ == b.pixel_; }

 private:
  Config config_;
  int width_;
  std::vector<std::optional<Fragment>> pixel_;
};

/// The same draws with and without hidden tiles.
class BothWays {
 public:
  BothWays(const Config& config, const DrawState& state)
      : with_(config, asking(state, true)),
        without_(config, asking(state, false)),
        seen_(config, state.width, state.height),
        all_(config, state.width, state.height) {}

  void draw(const SnappedQuad& quad) {
    with_.draw(quad, [&](std::span<const Fragment> fragments) {
      for (const Fragment& f : fragments) seen_.add(f);
    });
    without_.draw(quad, [&](std::span<const Fragment> fragments) {
      for (const Fragment& f : fragments) all_.add(f);
    });
  }
  void set_state(const DrawState& state) {
    with_.set_state(asking(state, true));
    without_.set_state(asking(state, false));
  }
  void clear() {
    with_.clear_hidden();
    seen_.clear();
    all_.clear();
  }
  bool same() const { return seen_ == all_; }
  std::size_t covered() const { return all_.covered(); }
  std::uint64_t hidden() const { return with_.stats().tiles_hidden; }
  std::uint64_t masked() const { return with_.stats().tiles_masked; }
  std::uint64_t pixels() const { return with_.stats().pixels; }

 private:
  static DrawState asking(DrawState state, bool hidden) {
    state.skip = hidden ? state.skip | skip_hidden : state.skip & ~std::uint32_t{skip_hidden};
    return state;
  }

  UntimedModel with_, without_;
  Picture seen_, all_;
};

inline DrawState viewport(int width, int height) {
  DrawState state;
  state.width = state.scissor_x1 = width;
  state.height = state.scissor_y1 = height;
  state.attributes = 0;
  return state;
}

/// An ordinary quad: corners (x, y, z), positions in pixels.
inline WindowQuad quad_of(std::uint32_t id, const std::array<std::array<double, 3>, 4>& corners) {
  WindowQuad quad;
  quad.id = id;
  for (std::size_t i = 0; i < 4; ++i) quad.vertex[i] = {corners[i][0], corners[i][1], corners[i][2], 1};
  return quad;
}
inline WindowQuad rectangle(std::uint32_t id, double x0, double y0, double x1, double y1, double z) {
  return quad_of(id, {{{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}}});
}

}  // namespace
}  // namespace quadrille
