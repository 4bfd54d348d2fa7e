#include "model/port/snap.hpp"
#include "model/untimed.hpp"
#include "tb/judge/judge.hpp"
#include "tb/verify/fuzz/fuzz_target.hpp"

#include <array>
#include <cstring>
#include <string>
#include <vector>

namespace quadrille::fuzz {
namespace {

/// Small enough that a quad over all of it is quick to judge, and more than one block of tiles wide.
constexpr int width = 72, height = 24;
constexpr int attributes = 2;

std::span<const Config> configurations() {
  static const std::array<Config, 4> list = [] {
    std::array<Config, 4> configs{};
    configs[1].significand_bits = 8;
    configs[2].significand_bits = 26;
    configs[3].subpixel_bits = 4;
    configs[3].align_guard_bits = 0;
    configs[3].attribute_slots = 2;
    for (const Config& config : configs) config.validate();
    return configs;
  }();
  return list;
}

DrawState state_of(const std::array<std::uint8_t, 4>& word) {
  DrawState state;
  state.width = width;
  state.height = height;
  state.scissor_x1 = width;
  state.scissor_y1 = height;
  if (word[1] & 1) {
    state.scissor_x0 = word[2] % width;
    state.scissor_x1 = state.scissor_x0 + 1 + word[2] / width;
    state.scissor_y0 = word[3] % height;
    state.scissor_y1 = std::min(height, state.scissor_y0 + 1 + word[3] / height);
    state.scissor_x1 = std::min(width, state.scissor_x1);
  }
  state.cull = static_cast<Cull>((word[1] >> 1) % 3);
  state.perspective = (word[1] & 8) == 0;
  state.depth = (word[1] & 16) == 0;
  if (word[1] & 32) {
    state.znear = 0.25;
    state.zfar = 0.75;
  }
  state.skip = (word[1] & 64) ? 0 : skip_default;
  state.attributes = attributes;
  return state;
}

WindowQuad quad_of(std::span<const std::uint8_t> numbers) {
  std::array<double, 16 + 4 * attributes> value{};
  std::memcpy(value.data(), numbers.data(), std::min(numbers.size(), sizeof value));
  WindowQuad quad;
  for (std::size_t i = 0; i < 4; ++i) {
    quad.vertex[i] = {value[4 * i], value[4 * i + 1], value[4 * i + 2], value[4 * i + 3]};
    for (std::size_t j = 0; j < attributes; ++j) quad.attribute[i].push_back(value[16 + attributes * i + j]);
  }
  return quad;
}

std::vector<Fragment> fragments_of(const SnappedQuad& quad, const Config& config, const DrawState& state,
                                   PixelEngine engine) {
  std::vector<Fragment> fragments;
  UntimedModel model(config, state, engine);
  model.draw(quad,
             [&](std::span<const Fragment> batch) { fragments.insert(fragments.end(), batch.begin(), batch.end()); });
  return fragments;
}

std::string text_of(const tb::CheckResult& result) {
  std::string text = result.first.text;
  for (const auto& counter : tb::fault_counters)
    text += std::string(" ") + counter.key + " " + std::to_string(result.*counter.value);
  return text;
}

/// Four bytes, the draw state and one of a few configurations, then any 16 doubles x̃ ỹ z̃ w and up to eight for two
/// attributes; what is missing is 0. A vertex that cannot be snapped is refused. Both pixel engines draw it, and every
/// fragment is held against the truth.
Outcome draw_any_quad(std::span<const std::uint8_t> input) {
  std::array<std::uint8_t, 4> word{};
  if (input.size() < word.size()) return Outcome::refused;
  std::memcpy(word.data(), input.data(), word.size());
  const Config& config = configurations()[word[0] % configurations().size()];
  const DrawState state = state_of(word);
  const WindowQuad quad = quad_of(input.subspan(word.size()));
  try {
    const SnappedQuad snapped = snap_quad(quad, config, state);
    if (fragments_of(snapped, config, state, PixelEngine::plain) !=
        fragments_of(snapped, config, state, PixelEngine::lanes))
      throw Fault("the engines differ");
    const tb::CheckResult result = tb::judge_untimed({&quad, 1}, attributes, config, state);
    if (result.faults() > 0) throw Fault(text_of(result));
  } catch (const SnapError&) {
    return Outcome::refused;
  }
  return Outcome::accepted;
}

constexpr Target list[]{{"any_quad", "any four vertices through both engines, against the truth", draw_any_quad,
                         "tb/verify/fuzz/corpus/any_quad", 400}};

}  // namespace

std::span<const Target> targets() { return list; }

}  // namespace quadrille::fuzz
