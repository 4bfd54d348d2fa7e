#include "tb/studies/method_timing.hpp"

#include "tb/studies/method_input.hpp"
#include "tb/support/stopwatch.hpp"

#include <algorithm>
#include <limits>

namespace quadrille::tb {

MethodTime time_method(const std::string& name, const DrawInput& input, const DrawState& state, int repeats) {
  const std::unique_ptr<golden::methods::Method> method = golden::methods::make_method(name);
  const std::vector<golden::methods::Quad> quads = method_quads(input, name);
  const golden::methods::View view = method_view(state);
  MethodTime time;
  time.seconds = std::numeric_limits<double>::infinity();
  std::vector<golden::methods::MethodSample> samples;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    time.samples = 0;
    const Stopwatch start;
    for (const golden::methods::Quad& quad : quads) {
      samples.clear();
      method->draw(quad, view, samples);
      time.samples += samples.size();
    }
    time.seconds = std::min(time.seconds, start.seconds());
  }
  time.ns_per_pixel =
      time.samples ? 1e9 * time.seconds / static_cast<double>(time.samples) : std::numeric_limits<double>::quiet_NaN();
  return time;
}

}  // namespace quadrille::tb
