// What tests/test_speed.py compares `quadrille.draw` with: a C++ program that draws the same quad with the untimed
// model and keeps every value of every fragment. Prints the seconds of the fastest of so many draws, and the fragments.
//   python_draw_time WIDTH HEIGHT DRAWS x0 y0 z0 w0 ... x3 y3 z3 w3
#include "model/port/draw_state.hpp"
#include "model/port/snap.hpp"
#include "model/untimed.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

int main(int argc, char** argv) {
  using namespace quadrille;
  if (argc != 20) return 2;
  const Config config;
  DrawState state = draw_state_for(config, std::atoi(argv[1]), std::atoi(argv[2]));
  state.attributes = 2;
  WindowQuad quad;
  for (std::size_t i = 0; i < 4; ++i) {
    char** const at = argv + 4 + 4 * i;
    quad.vertex[i] = {std::atof(at[0]), std::atof(at[1]), std::atof(at[2]), std::atof(at[3])};
    quad.attribute[i] = {i == 1 || i == 2 ? 1.0 : 0.0, i >= 2 ? 1.0 : 0.0};
  }
  double best = 1e9;
  std::size_t fragments = 0;
  for (int repeat = std::atoi(argv[3]); repeat > 0; --repeat) {
    const auto start = std::chrono::steady_clock::now();
    std::vector<FragmentPlace> place;
    std::vector<FragmentMarks> marks;
    std::vector<std::uint32_t> depth;
    std::vector<std::int64_t> u, v;
    UntimedModel model(config, state);
    model.draw_arrays(snap_quad(quad, config, state), [&](const FragmentArrays& f) {
      place.insert(place.end(), f.place, f.place + f.size);
      marks.insert(marks.end(), f.marks, f.marks + f.size);
      depth.insert(depth.end(), f.depth, f.depth + f.size);
      u.insert(u.end(), f.attribute[0], f.attribute[0] + f.size);
      v.insert(v.end(), f.attribute[1], f.attribute[1] + f.size);
    });
    fragments = place.size();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::printf("%.6f %zu\n", best, fragments);
}
