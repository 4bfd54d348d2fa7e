#include "golden/vectors/bench_draw.hpp"

#include "golden/scenes/stress.hpp"
#include "golden/vectors/machine_records.hpp"
#include "model/port/snap.hpp"

namespace quadrille::vectors {

BenchDraw make_bench_draw(const Config& config) {
  constexpr std::size_t of_each = 2;
  constexpr int side = 16;  // pixels of the viewport
  constexpr std::uint64_t seed = 1;
  constexpr std::size_t stalls = 256;  // clocks of the second column of clocks
  DrawState state = tb::small_state(config, side);
  state.attributes = config.attribute_slots;
  std::vector<SnappedQuad> quads;
  using enum golden::StressFamily;
  for (const golden::StressFamily family : {general, any_w, eye_crossing})
    for (WindowQuad quad : golden::make_stress(family, of_each, seed, 1, side, side, std::max(4, state.attributes))) {
      quad.id = static_cast<std::uint32_t>(quads.size());
      quads.push_back(snap_quad(quad, config, state));
    }

  const Layouts layouts(config);
  BenchDraw draw;
  draw.quads = quads.size();
  const StateRecord record{state, depth_code(state.znear, config), depth_code(state.zfar, config)};
  draw.states = packed(record, config, layouts.state).to_hex() + "\n";
  for (const SnappedQuad& quad : quads)
    for (std::size_t beat = 0; beat < 4; ++beat)
      draw.stimulus += packed(VertexRecord{0, beat_of(quad, beat)}, config, layouts.vertex).to_hex() + "\n";
  const auto [free, stalled] = run_both(quads, config, state, make_stalls(seed, stalls));
  draw.fragments = free.fragments.size();
  for (std::size_t n = 0; n < free.fragments.size(); ++n) {
    const auto& [fragment, clock] = free.fragments[n];
    draw.response +=
        packed(FragmentRecord{0, clock, stalled.fragments[n].clock, fragment}, config, layouts.fragment).to_hex() +
        "\n";
  }
  return draw;
}

}  // namespace quadrille::vectors
