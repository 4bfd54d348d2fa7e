// Hill climbing over quads and pixels for the largest arithmetic error of a weight, or with --output attribute or depth
// of such a value: |untimed model − truth on the same snapped input|, in units of 2^-s of weights 1 to 3, of an eighth
// of their bounds of everything else (tb/check/pixel_error.hpp). Bound: 8 units.
//
// The climb itself looks at one pixel through the pure functions of the model; the verdict on every climb's summit
// comes from UntimedModel against TruthQuad (PixelErrors). Starts are the stress families, whose shape a climb leaves;
// `quadrille stress --search` stays within it. Everything follows from --seed, whatever the number of threads.
//
// Short climbs (6 starts of 1600 steps, as in the tests) are also held to the regression limits of
// tb/check/error_limits.json. --record F --starts 6 --steps 1600 sets these there: the worst of --seeds seeds and
// the width of their interval on top. Exit status 1: beyond a limit; 2: bad usage, or a family of which nothing was
// drawn.
#include "tb/campaign/campaign_options.hpp"

#include "golden/io/atomic_file.hpp"
#include "golden/io/text_input.hpp"
#include "golden/scenes/stress.hpp"
#include "model/support/parallel.hpp"
#include "model/support/prng.hpp"
#include "tb/check/climb.hpp"
#include "tb/check/error_limits.hpp"
#include "tb/check/pixel_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace quadrille::campaign {
namespace {

using cli::Output;
using cli::PixelError;
using cli::PixelErrors;
using golden::Prng;

constexpr int viewport = 512;

struct Candidate {
  WindowQuad quad;
  golden::PixelPlace at;
};

/// PixelErrors switch depth on where it is looked at.
DrawState draw_state() {
  DrawState s;
  s.width = s.height = s.scissor_x1 = s.scissor_y1 = viewport;
  s.depth = false;  // no fragment may be lost to depth
  return s;
}

/// The attribute of a vertex, in [-1, 1], or its window z, in [0, 1]: anywhere, at an end, or a step away.
void mutate_value(Candidate& c, Output output, Prng& rng) {
  const std::size_t i = rng.below(4);
  WindowVertex& v = c.quad.vertex[i];
  const bool depth = output == Output::depth;
  if (depth && v.w == 0) return;
  const double low = depth ? 0 : -1;
  double value = depth ? v.z / v.w : c.quad.attribute[i][0];
  switch (rng.below(4)) {
    case 0:
      value = rng.chance(0.5) ? low : 1;
      break;
    case 1:
      value = rng.uniform(low, 1);
      break;
    case 2: {
      const WindowVertex& next = c.quad.vertex[(i + 1) % 4];
      value = !depth ? c.quad.attribute[(i + 1) % 4][0] : next.w != 0 ? next.z / next.w : value;
      break;
    }
    default:
      value += rng.sign() * rng.log2_spread(-20, -1);
  }
  value = std::clamp(value, low, 1.0);
  (depth ? v.z : c.quad.attribute[i][0]) = depth ? value * v.w : value;
}

Candidate mutate(const Candidate& from, Output output, Prng& rng) {
  Candidate c = from;
  if (output != Output::weight && rng.chance(0.3)) {
    mutate_value(c, output, rng);
    return c;
  }
  const auto step = [&] { return rng.sign() * rng.log2_spread(-9, rng.chance(0.3) ? 8 : 2); };
  const auto moved = [](WindowVertex& v, double dx, double dy) {
    const double scale = v.w != 0 ? std::fabs(v.w) : 1;
    v.x += scale * dx;
    v.y += scale * dy;
  };
  for (std::uint64_t changes = 1 + rng.below(3); changes > 0; --changes) {
    WindowVertex& v = c.quad.vertex[rng.below(4)];
    switch (rng.below(9)) {
      case 0:
      case 1:
        moved(v, step(), step());
        break;
      case 2:
        moved(v, rng.chance(0.5) ? 1 / 256.0 : -1 / 256.0, 0);
        break;
      case 3:
        moved(v, 0, rng.chance(0.5) ? 1 / 256.0 : -1 / 256.0);
        break;
      case 4: {  // the same position, another w
        const double f = rng.chance(0.5) ? rng.log2_spread(-2, 2) : 1 + rng.uniform(-0.01, 0.01);
        v.x *= f, v.y *= f, v.z *= f, v.w *= f;
        break;
      }
      case 5:
        v.w *= 1 + rng.uniform(-0.1, 0.1);
        break;
      case 6:
        c.at = cli::near_pixel(c.at, viewport, viewport, rng);
        break;
      case 7: {  // the whole quad against the pixel
        const double dx = step(), dy = step();
        for (WindowVertex& u : c.quad.vertex) moved(u, dx, dy);
        break;
      }
      default:  // closer to the pixel or farther from it
        if (v.w > 0) {
          const double f = rng.log2_spread(-2, 1), px = c.at.x + 0.5, py = c.at.y + 0.5;
          v.x = v.w * (px + (v.x / v.w - px) * f);
          v.y = v.w * (py + (v.y / v.w - py) * f);
        } else {
          moved(v, step(), step());
        }
    }
  }
  return c;
}

struct Summit {
  Candidate at;
  PixelError error;
  std::uint64_t evaluations = 0;
};

/// One climb from one quad of a family.
Summit climb(PixelErrors& errors, Output output, const WindowQuad& start, std::uint64_t steps, std::uint64_t seed) {
  Prng rng(seed);
  cli::Climb climb(Candidate{start, {}}, [&](const Candidate& c) { return errors.measure(c.quad, c.at.x, c.at.y); });
  Summit out;
  // The worst of some drawn pixels, found by throwing darts at the bounding box.
  const cli::PixelBox box(start, viewport, viewport);
  for (int dart = 0, hits = 0; dart < 400 && hits < 40; ++dart) hits += climb.start({start, box.pick(rng)}) >= 0;
  if (climb.height() >= 0) {
    for (std::uint64_t n = 0; n < steps; ++n) climb.step(mutate(climb.best(), output, rng));
    out.at = climb.best();
    out.error = errors.judge(out.at.quad, out.at.at.x, out.at.at.y);
  }
  out.evaluations = climb.evaluations();
  return out;
}

void print_witness(const Candidate& c) {
  std::printf("# pixel (%d, %d)\n", c.at.x, c.at.y);
  for (const WindowVertex& v : c.quad.vertex) std::printf("%.17g %.17g %.17g %.17g  ", v.x, v.y, v.z, v.w);
  for (const std::vector<double>& attributes : c.quad.attribute)
    for (const double a : attributes) std::printf("%.17g ", a);
  std::printf("\n");
}

/// Starts and steps up to which the recorded limits hold: longer climbs find more.
constexpr std::uint64_t limit_starts = 6, limit_steps = 1600;

class HillClimb {
 public:
  explicit HillClimb(const Options& options)
      : options_(options),
        starts_(options.number("starts")),
        steps_(options.number("steps")),
        output_(output_of(options)) {}

  int run() {
    const std::string file = options_.text("record");
    if (!file.empty()) {
      if (output_ != Output::weight) throw std::invalid_argument("--record is of weights");
      return record(file);
    }
    const std::uint64_t seed = options_.number("seed");
    const auto bound = static_cast<double>(options_.number("bound"));
    std::printf(
        "hill climbing: %zu families x %llu starts x %llu steps, seed %llu; %s in units of which the bound has %g\n",
        golden::stress_families().size(), static_cast<unsigned long long>(starts_),
        static_cast<unsigned long long>(steps_), static_cast<unsigned long long>(seed), options_.text("output").c_str(),
        bound);
    bool ok = true;
    for (const std::uint64_t bits : options_.numbers("significand-bits")) {
      const int s = static_cast<int>(bits);
      const std::vector<Summit> summits = climb_all(s, seed);
      const Summit* worst = report(s, summits);
      if (worst == nullptr) continue;
      if (!(worst->error.units <= bound)) {
        ok = false;
        std::printf("s %2d: BOUND EXCEEDED\n", s);
      }
      const double limit = limits_apply() ? cli::ErrorLimits::recorded().hill_climb(s) : bound;
      if (!(worst->error.units <= limit)) {
        ok = false;
        std::printf("s %2d: REGRESSION LIMIT of %g units EXCEEDED\n", s, limit);
      }
      std::fflush(stdout);
    }
    if (!undrawn_.empty())
      std::fprintf(stderr, "hill_climb: nothing was drawn, so nothing was shown, of%s; give more --starts than %llu\n",
                   undrawn_.c_str(), static_cast<unsigned long long>(starts_));
    return !ok ? 1 : undrawn_.empty() ? 0 : 2;
  }

 private:
  /// Limits around the worst of several seeds; the file's other contents stay.
  int record(const std::string& file) {
    cli::ErrorLimits limits = cli::ErrorLimits::parse(golden::read_file(file, "error limits"));
    for (const std::uint64_t bits : options_.numbers("significand-bits")) {
      const int s = static_cast<int>(bits);
      std::vector<double> found;
      for (std::uint64_t n = 0; n < options_.number("seeds"); ++n) {
        double units = 0;
        for (const Summit& summit : climb_all(s, options_.number("seed") + n))
          units = std::max(units, summit.error.units);
        std::printf("s %2d seed %llu: %.3f units\n", s, static_cast<unsigned long long>(options_.number("seed") + n),
                    units);
        std::fflush(stdout);
        found.push_back(units);
      }
      limits.set_hill_climb(s, cli::LimitRange::around(found, 1).high());
    }
    golden::write_file(file, limits.text(), golden::AtomicFile::Dash::refused);
    return 0;
  }

  bool limits_apply() const {
    return output_ == Output::weight && starts_ <= limit_starts && steps_ <= limit_steps &&
           options_.number("notch-exact") == 1 &&
           options_.number("align-guard-bits") == static_cast<std::uint64_t>(Config{}.align_guard_bits);
  }

  /// Family by family, `starts` climbs each.
  std::vector<Summit> climb_all(int significand_bits, std::uint64_t seed) const {
    const auto bits = static_cast<std::uint64_t>(significand_bits);
    Config config;
    config.set("significand_bits", significand_bits);
    config.set("notch_exact", static_cast<int>(options_.number("notch-exact")));
    config.set("align_guard_bits", static_cast<int>(options_.number("align-guard-bits")));
    config.validate();
    std::vector<std::vector<WindowQuad>> quads;
    for (const auto& info : golden::stress_families())
      quads.push_back(
          output_ == Output::weight
              ? golden::make_stress(info.family, starts_, seed * 1000 + bits, 1.0, viewport, viewport, 4)
              : golden::make_stress_without_weights(info.family, starts_, seed * 1000 + bits, viewport, viewport, 1));
    std::vector<Summit> summits(quads.size() * starts_);
    parallel_for(summits.size(), options_.threads(), [&](std::size_t i) {
      PixelErrors errors(config, draw_state(), output_);
      summits[i] = climb(errors, output_, quads[i / starts_][i % starts_], steps_,
                         seed * 0x9e3779b97f4a7c15u + bits * 1000003 + i);
    });
    return summits;
  }

  /// The worst of each family and of all; a family that draws nothing shows nothing.
  const Summit* report(int s, const std::vector<Summit>& summits) {
    const Summit* worst = nullptr;
    std::uint64_t evaluations = 0;
    for (std::size_t f = 0; f < golden::stress_families().size(); ++f) {
      const std::string name(golden::stress_families()[f].name);
      const Summit* top = nullptr;
      std::uint64_t climbed = 0;
      for (std::size_t i = f * starts_; i < (f + 1) * starts_; ++i) {
        evaluations += summits[i].evaluations;
        if (summits[i].error.units < 0) continue;
        ++climbed;
        if (top == nullptr || summits[i].error.units > top->error.units) top = &summits[i];
      }
      if (top == nullptr) {
        std::printf("s %2d %-16s nothing was drawn in %llu starts\n", s, name.c_str(),
                    static_cast<unsigned long long>(starts_));
        undrawn_ += (undrawn_.empty() ? " " : ", ") + name + " (s = " + std::to_string(s) + ")";
        continue;
      }
      std::printf("s %2d %-16s %6.3f units (condition %.2g, flags 0x%02x, %llu climbs)\n", s, name.c_str(),
                  top->error.units, top->error.condition, top->error.flags, static_cast<unsigned long long>(climbed));
      if (worst == nullptr || top->error.units > worst->error.units) worst = top;
    }
    if (worst == nullptr) return nullptr;
    std::printf("s %2d worst: %.3f units after %llu evaluations, witness:\n", s, worst->error.units,
                static_cast<unsigned long long>(evaluations));
    print_witness(worst->at);
    return worst;
  }

  static Output output_of(const Options& options) {
    const auto found = std::ranges::find(cli::output_names, options.text("output"));
    if (found == cli::output_names.end())
      throw std::invalid_argument("--output is weight, attribute or depth, not " + options.text("output"));
    return static_cast<Output>(found - cli::output_names.begin());
  }

  const Options& options_;
  const std::uint64_t starts_, steps_;
  const Output output_;
  std::string undrawn_;  ///< families without a climb, with the width
};

int run(int argc, char** argv) {
  const Options options(argc, argv,
                        {{"significand-bits", "12,18,24"},
                         {"starts", "40"},
                         {"steps", "2000"},
                         {"seed", "1"},
                         {"seeds", "12"},
                         {"threads", "0"},
                         {"notch-exact", "1"},
                         {"align-guard-bits", "2"},
                         {"bound", "8"},
                         {"output", "weight"},
                         {"record", ""}});
  return HillClimb(options).run();
}

}  // namespace
}  // namespace quadrille::campaign

int main(int argc, char** argv) {
  return quadrille::campaign::guarded("hill_climb", quadrille::campaign::run, argc, argv);
}
