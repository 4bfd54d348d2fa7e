// Draws the quads of a file with the untimed model and holds every attribute against the exact one.
//
//     untimed FILE     a quad a line: x y z w of four vertices, then four attributes of each
//
// Prints a line of integers for every fragment.
#include <quadrille/golden/reference/truth.hpp>
#include <quadrille/model/snap.hpp>
#include <quadrille/model/untimed.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

int main(int, char** argv) {
  const quadrille::Config config;
  quadrille::DrawState state;
  state.width = state.height = state.scissor_x1 = state.scissor_y1 = 64;
  quadrille::UntimedModel machine(config, state);

  double worst = 0;
  std::ifstream file(argv[1]);
  const auto read = [&](quadrille::WindowQuad& quad) {
    for (auto& v : quad.vertex) file >> v.x >> v.y >> v.z >> v.w;
    for (auto& values : quad.attribute) {
      values.resize(4);
      for (double& value : values) file >> value;
    }
    return static_cast<bool>(file);
  };
  for (quadrille::WindowQuad given; read(given); ++given.id) {
    const quadrille::SnappedQuad quad = snap_quad(given, config, state);
    const quadrille::golden::TruthQuad truth(quad, config, state);
    machine.draw(quad, [&](std::span<const quadrille::Fragment> fragments) {
      for (const quadrille::Fragment& f : fragments) {
        std::printf("%u %u %u %d %u %u", f.quad, f.x, f.y, f.front, f.flags, f.depth);
        for (std::size_t i = 0; i < 4; ++i) {
          const double value = std::ldexp(static_cast<double>(f.attribute[i]), -config.attribute_frac());
          worst = std::max(worst, std::abs(value - truth.sample(f.x, f.y).attribute[i]));
          std::printf(" %lld", static_cast<long long>(f.attribute[i]));
        }
        std::printf("\n");
      }
    });
  }
  std::fprintf(stderr, "largest attribute error 2^%.1f\n", std::log2(worst));
}
