// For the tests: the lanes against the plain pipeline in WebAssembly, where they round toward zero by themselves.
#include "golden/scenes/stress.hpp"
#include "model/port/config_text.hpp"
#include "model/port/draw_state.hpp"
#include "model/port/snap.hpp"
#include "model/untimed.hpp"

#include <string>
#include <vector>

using namespace quadrille;

namespace {

std::string text;

std::vector<Fragment> fragments(const Config& config, const DrawState& state, const std::vector<WindowQuad>& quads,
                                PixelEngine engine) {
  UntimedModel model(config, state, engine);
  std::vector<Fragment> out;
  for (const WindowQuad& quad : quads)
    model.draw(snap_quad(quad, config, state),
               [&](std::span<const Fragment> some) { out.insert(out.end(), some.begin(), some.end()); });
  return out;
}

}  // namespace

extern "C" __attribute__((export_name("input"))) char* input(std::size_t size) {
  text.resize(size);
  return text.data();
}
extern "C" __attribute__((export_name("families"))) int families() {
  return static_cast<int>(golden::stress_families().size());
}
/// Fragments that both have drawn alike of random quads of a family; -1: not alike. The input is a configuration.
extern "C" __attribute__((export_name("compare"))) int compare(int family, int count, int seed) {
  Config config;
  apply_config_text(text, config);
  const DrawState state = draw_state_for(config, 128, 96);
  const std::vector<WindowQuad> quads = golden::make_stress_without_weights(
      golden::stress_families()[static_cast<std::size_t>(family)].family, static_cast<std::size_t>(count),
      static_cast<std::uint64_t>(seed), state.width, state.height, state.attributes);
  const std::vector<Fragment> plain = fragments(config, state, quads, PixelEngine::plain);
  return plain == fragments(config, state, quads, PixelEngine::lanes) ? static_cast<int>(plain.size()) : -1;
}
