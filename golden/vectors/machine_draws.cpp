// The draws of machine suites.
#include "golden/io/error.hpp"
#include "golden/scenes/stress.hpp"
#include "golden/vectors/machine_records.hpp"
#include "model/port/latency.hpp"
#include "model/port/snap.hpp"
#include "model/untimed.hpp"

#include <algorithm>
#include <limits>
#include <string>

namespace quadrille::vectors {
namespace {

constexpr std::uint64_t level_fragments[] = {3'000, 300'000};

/// Cuts a draw off after the quad with which it has `limit` fragments, or after `limit` quads, never before the first;
/// with `some`, not before its first fragment either. Returns how many fragments it has.
std::uint64_t limit_draw(MachineDraw& draw, const Config& config, std::uint64_t limit, bool some) {
  UntimedModel model(config, draw.state);
  std::size_t count = 0;
  const auto go_on = [&] {
    const std::uint64_t fragments = model.stats().fragments;
    return fragments < limit && (count < limit || (some && fragments == 0));
  };
  while (count < draw.quads.size() && go_on()) model.draw_arrays(draw.quads[count++], [](const FragmentArrays&) {});
  draw.quads.resize(count);
  return model.stats().fragments;
}

/// How many quads of a draw have ids of their own.
std::size_t most_quads(const Config& config) { return std::size_t{1} << config.quad_id_bits; }

[[noreturn]] void refuse_empty(const std::string& suite, const GenerateOptions& options, std::size_t quads) {
  throw golden::InputError("suite " + suite + ": the first " + std::to_string(quads) +
                           " quads draw no fragment with this seed and configuration (limit " +
                           std::to_string(options.limit) + "); expected vectors");
}

std::uint64_t fragment_limit(const GenerateOptions& options) {
  return options.limit != 0 ? options.limit : level_fragments[options.level - 1];
}

/// Two rectangles of 16 × 8 pixels on corners of tiles, one behind the other.
std::vector<SnappedQuad> two_layers(const Config& config, const DrawState& state) {
  std::vector<SnappedQuad> quads;
  for (const double z : {0.05, 0.95}) {
    WindowQuad quad;
    quad.id = static_cast<std::uint32_t>(quads.size());
    quad.vertex = {{{16, 16, z, 1}, {16, 24, z, 1}, {32, 24, z, 1}, {32, 16, z, 1}}};
    for (auto& attribute : quad.attribute) attribute.assign(static_cast<std::size_t>(state.attributes), 0.5);
    quads.push_back(snap_quad(quad, config, state));
  }
  return quads;
}

/// The same random quads under every draw state.
std::vector<MachineDraw> every_state(const GenerateOptions& options) {
  const DrawState normal = picture_state(options.config);
  std::vector<DrawState> states{normal};
  const auto add = [&](auto&& change) {
    states.push_back(normal);
    change(states.back());
  };
  add([](DrawState& s) { s.perspective = false; });
  add([](DrawState& s) { s.depth = false; });
  add([](DrawState& s) { s.cull = Cull::front; });
  add([](DrawState& s) { s.cull = Cull::back; });
  add([](DrawState& s) { s.znear = 0.375, s.zfar = 0.625; });
  add([](DrawState& s) { s.scissor_x0 = 5, s.scissor_y0 = 9, s.scissor_x1 = 37, s.scissor_y1 = 30; });
  add([](DrawState& s) { s.scissor_x1 = s.scissor_x0; });
  add([](DrawState& s) { s.attributes = 0; });
  add([](DrawState& s) { s.attributes = 1; });
  add([](DrawState& s) { s.skip = 0; });
  if (options.config.hierarchical_z_bits != 0) add([](DrawState& s) { s.skip |= skip_hidden; });
  std::vector<MachineDraw> draws;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const auto count = static_cast<int>(std::min<std::size_t>(2000, most_quads(options.config)));
    draws.push_back({states[i], tb::random_quads(options.config, states[i], options.seed + i, count)});
    // Something to hide before the limit is reached
    if ((states[i].skip & skip_hidden) != 0)
      std::ranges::copy(two_layers(options.config, states[i]), draws.back().quads.begin());
    // The other states may draw nothing, such as that with an empty scissor rectangle.
    const std::uint64_t fragments =
        limit_draw(draws.back(), options.config, fragment_limit(options) / states.size() + 1, i == 0);
    if (i == 0 && fragments == 0) refuse_empty("machine", options, draws.back().quads.size());
  }
  return draws;
}

std::vector<MachineDraw> stress_draw(golden::StressFamily family, const GenerateOptions& options) {
  MachineDraw draw;
  draw.state = picture_state(options.config);
  const std::uint64_t limit = fragment_limit(options);
  // Small families need many quads, and with a small limit the first ones may miss every pixel.
  const std::size_t most = most_quads(options.config);
  for (std::size_t count : {std::max<std::size_t>(16, static_cast<std::size_t>(limit / 4)), std::size_t{4096}}) {
    count = std::min(count, most);
    draw.quads.clear();
    for (const WindowQuad& quad : golden::make_stress(family, count, options.seed, 1, picture_size, picture_size,
                                                      std::max(4, draw.state.attributes)))
      draw.quads.push_back(snap_quad(quad, options.config, draw.state));
    if (limit_draw(draw, options.config, limit, true) > 0) return {std::move(draw)};
  }
  refuse_empty("stress_" + std::string(golden::stress_family_name(family)), options, draw.quads.size());
}

}  // namespace

MachineDraw MachineSuite::snap_draw(const std::vector<WindowQuad>& quads, const DrawState& state,
                                    const Config& config) {
  MachineDraw draw{state, {}};
  for (const WindowQuad& quad : quads) draw.quads.push_back(snap_quad(quad, config, state));
  return draw;
}

MachineDraw MachineSuite::limited(MachineDraw draw, const GenerateOptions& options) {
  const std::size_t quads = draw.quads.size();
  const std::uint64_t fragments =
      limit_draw(draw, options.config, options.limit != 0 ? options.limit : largest_limit + 1, true);
  if (fragments == 0)
    throw golden::InputError("none of the input's quads (" + std::to_string(quads) + ") draws a fragment");
  if (options.limit == 0 && (fragments > largest_limit || draw.quads.size() < quads))
    throw golden::InputError("the input's " + std::to_string(quads) +
                             " quads are too many for a set, or draw more than " + std::to_string(largest_limit) +
                             " fragments; use --limit N or a smaller --size");
  return draw;
}

void add_machine_suites(std::vector<std::unique_ptr<Suite>>& suites) {
  const auto info = [](std::string name, std::string title) {
    return SuiteInfo{std::move(name), "machine",         std::move(title),
                     "quadrille",     latency::pipeline, "x = y = w = 0, and whatever snapping refuses"};
  };
  suites.push_back(
      std::make_unique<MachineSuite>(info("machine", "The whole machine under every draw state"), every_state));
  for (const golden::StressFamilyInfo& family : golden::stress_families())
    suites.push_back(std::make_unique<MachineSuite>(
        info("stress_" + std::string(family.name), "The whole machine: " + std::string(family.stresses)),
        [kind = family.family](const GenerateOptions& options) { return stress_draw(kind, options); }));
}

}  // namespace quadrille::vectors
