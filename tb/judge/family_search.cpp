#include "tb/judge/family_search.hpp"

#include "model/support/prng.hpp"
#include "tb/judge/climb.hpp"
#include "tb/judge/vertex_moves.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace quadrille::tb {
namespace {

using golden::Prng;

constexpr std::size_t summits = 4;        ///< climbs from so many starts
constexpr int darts_of_a_quad = 12;       ///< pixels looked at of each quad drawn
constexpr double knob_octaves = 6;        ///< that make_stress takes, to either side of 1
constexpr std::uint64_t late_words = 24;  ///< of a drawing that was taken after others, the last are the quad's

class Search {
 public:
  Search(const FamilySearch& search, const std::function<double(const FamilyCandidate&)>& measure)
      : search_(search),
        measure_(measure),
        rng_(search.seed,
             1 + static_cast<std::uint64_t>(search.family) * 8 + static_cast<std::uint64_t>(search.output)) {}

  std::vector<FamilySummit> run() {
    std::vector<FamilyClimb> starts;
    const std::uint64_t drawn = std::max<std::uint64_t>(1, search_.evaluations / 8);
    while (used_ < drawn) {
      FamilyClimb climb = dart(drawn - used_);
      used_ += climb.evaluations();
      if (climb.height() < 0) continue;
      starts.push_back(std::move(climb));
      std::ranges::stable_sort(starts, std::ranges::greater(), &FamilyClimb::height);
      if (starts.size() > summits) starts.pop_back();
    }
    std::vector<FamilySummit> ends;
    for (std::size_t i = 0; i < starts.size(); ++i) {
      FamilyClimb& climb = starts[i];
      const std::uint64_t steps = (search_.evaluations - used_) / (starts.size() - i);
      for (std::uint64_t n = 0; n < steps; ++n) climb.step(changed(climb.best()));
      used_ += steps;
      ends.push_back({climb.best(), climb.height()});
    }
    std::ranges::stable_sort(ends, std::ranges::greater(), &FamilySummit::units);
    return ends;
  }

 private:
  using Measure = std::function<double(const FamilyCandidate&)>;
  using FamilyClimb = Climb<FamilyCandidate, Measure>;

  /// The highest of some pixels of a quad at random.
  FamilyClimb dart(std::uint64_t most) {
    FamilyCandidate c;
    if (has_knob_ && rng_.chance(0.5)) c.drawing.knob = rng_.log2_spread(-knob_octaves, knob_octaves);
    c.drawing.seed = rng_.next();
    c.drawing.member = rng_.below(64);
    draw(c);
    for (std::vector<double>& a : c.quad.attribute) a = {rng_.uniform(-1, 1)};
    FamilyClimb climb(c, measure_);
    const PixelBox box(c.quad, search_.width, search_.height);
    for (std::uint64_t n = 0; n < std::min<std::uint64_t>(most, darts_of_a_quad); ++n) {
      c.at = box.pick(rng_);
      climb.start(c);
    }
    return climb;
  }

  void draw(FamilyCandidate& c) const {
    c.quad.vertex = golden::draw_stress(search_.family, c.drawing, search_.width, search_.height).vertex;
  }

  FamilyCandidate changed(FamilyCandidate c) {
    if (search_.leave) {
      move_vertices(c.quad, c.at, search_.output, search_.width, search_.height, rng_);
      return c;
    }
    bool drawn = false;
    for (std::uint64_t changes = 1 + rng_.below(3); changes > 0; --changes) {
      switch (rng_.below(8)) {
        case 0:
          c.at = rng_.chance(0.75) ? near_pixel(c.at, search_.width, search_.height, rng_)
                                   : PixelBox(c.quad, search_.width, search_.height).pick(rng_);
          break;
        case 1:
          if (search_.output == Output::attribute) {
            change_attribute(c.quad.attribute[rng_.below(4)][0]);
            break;
          }
          [[fallthrough]];
        default:
          change_word(c.drawing.words);
          drawn = true;
          break;
        case 2: {
          if (!has_knob_) break;
          const double factor = 1 + rng_.sign() * rng_.log2_spread(-12, -1);
          c.drawing.knob = std::clamp(c.drawing.knob * factor, std::ldexp(1.0, -static_cast<int>(knob_octaves)),
                                      std::ldexp(1.0, static_cast<int>(knob_octaves)));
          drawn = true;
        }
      }
    }
    if (drawn) draw(c);
    return c;
  }

  /// In [−1, 1], often to where a single weight's error, or all of one sign, are seen.
  void change_attribute(double& attribute) {
    switch (rng_.below(4)) {
      case 0:
        attribute = static_cast<double>(rng_.integer(-1, 1));
        break;
      case 1:
        attribute = rng_.uniform(-1, 1);
        break;
      default: {
        const double step = rng_.sign() * rng_.log2_spread(-16, 0);
        attribute = std::clamp(attribute + step, -1.0, 1.0);
      }
    }
  }

  void change_word(std::vector<std::uint64_t>& words) {
    const std::uint64_t late = std::min<std::uint64_t>(words.size(), late_words);
    const std::uint64_t from = rng_.chance(0.5) ? words.size() - late : 0;
    std::uint64_t& word = words[from + rng_.below(words.size() - from)];
    if (rng_.chance(0.15)) {
      word = rng_.next();
      return;
    }
    const std::uint64_t step = rng_.next() >> (1 + rng_.below(24));
    const bool down = rng_.chance(0.5);
    // An end of the range stops it: beyond it lies the other one.
    if (down)
      word = word < step ? 0 : word - step;
    else
      word = UINT64_MAX - word < step ? UINT64_MAX : word + step;
  }

  const FamilySearch& search_;
  const Measure& measure_;
  const bool has_knob_ =
      golden::stress_families()[static_cast<std::size_t>(search_.family)].knob != golden::no_stress_knob;
  Prng rng_;
  std::uint64_t used_ = 0;
};

}  // namespace

DrawState search_state(int width, int height) {
  DrawState state;
  state.width = state.scissor_x1 = width;
  state.height = state.scissor_y1 = height;
  return state;
}

WindowQuad quad_for(const WindowQuad& quad, Output output) {
  WindowQuad out = quad;
  if (output == Output::weight)
    for (std::size_t i = 0; i < 4; ++i) {
      out.attribute[i].assign(4, 0);
      out.attribute[i][i] = 1;
    }
  return out;
}

std::vector<FamilySummit> search_family(const FamilySearch& search,
                                        const std::function<double(const FamilyCandidate&)>& measure) {
  return Search(search, measure).run();
}

std::vector<FamilySummit> search_family(const FamilySearch& search) {
  const PixelErrors errors(search.config, search_state(search.width, search.height), search.output);
  return search_family(search, [&](const FamilyCandidate& c) {
    return errors.measure(quad_for(c.quad, search.output), c.at.x, c.at.y);
  });
}

std::optional<FamilySummit> worst_of_family(const FamilySearch& search) {
  std::optional<FamilySummit> worst;
  PixelErrors errors(search.config, search_state(search.width, search.height), search.output);
  for (FamilySummit& summit : search_family(search)) {
    const FamilyCandidate& c = summit.candidate;
    summit.units = errors.judge(quad_for(c.quad, search.output), c.at.x, c.at.y).units;
    if (summit.units >= 0 && (!worst || summit.units > worst->units)) worst = std::move(summit);
  }
  return worst;
}

}  // namespace quadrille::tb
