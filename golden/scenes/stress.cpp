#include "golden/scenes/stress.hpp"

#include "golden/scenes/generators.hpp"
#include "golden/scenes/stress_batch.hpp"
#include "model/support/prng.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace quadrille::golden::stress {
namespace {

struct Generator {
  StressFamilyInfo info;
  void (*make)(Batch&);
};

constexpr std::array<Generator, 22> generators{{
    {{StressFamily::general, "general", "four random corners, any shape, w = 1: the common case", "size"}, general},
    {{StressFamily::perspective, "perspective", "w ratio 100 between two corners: k spreads over the sums",
      "exponent of the ratio 100"},
     perspective},
    {{StressFamily::any_w, "any_w",
      "w of any sign and magnitude, one in eight zero: homogeneous edge functions, visibility", "octaves of |w|"},
     any_w},
    {{StressFamily::near_edge, "near_edge", "edges within 1/16 px of the pixel centres along them: cancellation in A",
      "distance"},
     near_edge},
    {{StressFamily::on_edge, "on_edge", "edges exactly through pixel centres, corners there or not: ties, A = 0",
      "nothing"},
     on_edge},
    {{StressFamily::near_vertex, "near_vertex", "corners 2^-9 to 1 px from pixel centres on small quads: R close to 0",
      "distance"},
     near_vertex},
    {{StressFamily::on_vertex, "on_vertex",
      "corners exactly at pixel centres: R = 0, ties on two edges and the diagonal", "size"},
     on_vertex},
    {{StressFamily::sliver, "sliver", "long quads 1/64 to 1 px thick: all A small together", "thickness"}, sliver},
    {{StressFamily::collapsed_edge, "collapsed_edge",
      "two neighbouring corners equal, a quarter at most 1 px apart: t = 0 or tiny", "length of the short edges"},
     collapsed_edge},
    {{StressFamily::straight_corner, "straight_corner",
      "a corner on its neighbours' line, exactly or by 1/256 px: 180 or 0 degrees", "offset"},
     straight_corner},
    {{StressFamily::reflex, "reflex",
      "notches of 1/4 to 16 px with the tip near a pixel centre: t of both signs cancel", "width"},
     reflex},
    {{StressFamily::bowtie, "bowtie",
      "crossed quads, half with the crossing exactly at a pixel centre: two edges at once", "nothing"},
     bowtie},
    {{StressFamily::tiny, "tiny", "quads under 4 px: few bits in every difference", "size"}, tiny},
    {{StressFamily::huge, "huge", "corners 2^17 to 2^24 px away, beyond any guard band, with visible pixels",
      "distance"},
     huge},
    {{StressFamily::eye_crossing, "eye_crossing",
      "one to three corners behind the eye, visible, the eye outside their hull", "octaves of |w|"},
     eye_crossing},
    {{StressFamily::eye_in_hull, "eye_in_hull",
      "the eye inside the tetrahedron of the corners: visibility pixel by pixel", "octaves of |w|"},
     eye_in_hull},
    {{StressFamily::w_zero, "w_zero", "one or two corners with w = 0 exactly: points at infinity", "octaves of |w|"},
     w_zero},
    {{StressFamily::shared_edge, "shared_edge", "strips of quads with common edges, any winding: gaps and doubles",
      "cell size"},
     shared_edge},
    {{StressFamily::shared_vertex, "shared_vertex",
      "fans of quads around one vertex, often at a pixel centre: gaps and doubles", "radius"},
     shared_vertex},
    {{StressFamily::coplanar, "coplanar",
      "all corners on one screen line, seen edge-on, exactly or by 1/256 px: zero areas", "offset"},
     coplanar},
    {{StressFamily::long_span, "long_span",
      "from side to side of the viewport, often thin: forward differences over long spans", "thickness"},
     long_span},
    {{StressFamily::coincident, "coincident",
      "two, three or four equal corners, neighbours or opposite: edges without a sign", "nothing"},
     coincident},
}};

constexpr auto infos = infos_of(generators);

void check_arguments(double knob, int width, int height) {
  if (!(knob >= 0x1p-6 && knob <= 0x1p6)) throw std::invalid_argument("stress: the knob lies between 1/64 and 64");
  if (width < 1 || height < 1 || width > 32768 || height > 32768) {
    throw std::invalid_argument("stress: size " + std::to_string(width) + "x" + std::to_string(height) +
                                " (1x1 to 32768x32768)");
  }
}

/// Window depths of a spread of 2^-1 to 2^-24 of what it was, about that of a corner in front of the eye.
void draw_depths_together(Prng& rng, Vertices& v) {
  const double part = std::ldexp(1.0, static_cast<int>(rng.integer(-24, -1)));
  const auto first = std::ranges::find_if(v, [](const WindowVertex& q) { return q.w > 0; });
  if (first == v.end()) return;
  const double depth = first->z / first->w;
  for (WindowVertex& q : v) q.z = depth * q.w + part * (q.z - depth * q.w);
}

/// Slots 0 to 3 hold the weights. Of the others even ones hold any numbers, odd ones a number far from 0 and others of
/// a spread of 2^-1 to 2^-24 of it.
void add_attribute(Prng& rng, std::size_t slot, WindowQuad& quad) {
  const bool together = slot >= 4 && slot % 2 == 1;
  const double base = together ? rng.sign() * rng.uniform(0.75, 1) : 0;
  const double part = together ? std::ldexp(1.0, static_cast<int>(rng.integer(-24, -1))) : 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double weight = slot == i ? 1 : 0;
    quad.attribute[i].push_back(slot < 4 ? weight : together ? base * (1 - part * rng.uniform()) : rng.uniform(-1, 1));
  }
}

}  // namespace
}  // namespace quadrille::golden::stress

namespace quadrille::golden {

std::span<const StressFamilyInfo> stress_families() { return stress::infos; }

std::string_view stress_family_name(StressFamily family) {
  return stress::infos[static_cast<std::size_t>(family)].name;
}

StressFamily parse_stress_family(std::string_view name) {
  std::string all;
  for (const StressFamilyInfo& info : stress::infos) {
    if (info.name == name) return info.family;
    all += ' ';
    all += info.name;
  }
  throw std::invalid_argument("no stress family '" + std::string(name) + "'; families:" + all);
}

std::vector<WindowQuad> make_stress(StressFamily family, std::size_t count, std::uint64_t seed, double knob, int width,
                                    int height, int attributes) {
  stress::check_arguments(knob, width, height);
  check_attributes("stress", attributes, max_attribute_slots);
  const std::size_t index = static_cast<std::size_t>(family);
  const std::uint64_t own_seed =
      Prng(seed ^ ((index + 1) * 0xd1342543de82ef95u)).next();  // one sequence per family and seed
  stress::Batch batch{stress::Numbers(own_seed), knob, width, height, count};
  batch.quads.reserve(count);
  while (!batch.full()) stress::generators[index].make(batch);

  Prng attribute_rng(~own_seed), depth_rng(~own_seed, 1);
  const bool shares_corners = family == StressFamily::shared_edge || family == StressFamily::shared_vertex;
  std::vector<WindowQuad> quads(count);
  for (std::size_t q = 0; q < count; ++q) {
    quads[q].id = static_cast<std::uint32_t>(q);
    quads[q].vertex = batch.quads[q];
    if (q % 4 == 3 && !shares_corners) stress::draw_depths_together(depth_rng, quads[q].vertex);
    for (std::size_t a = 0; a < static_cast<std::size_t>(attributes); ++a)
      stress::add_attribute(attribute_rng, a, quads[q]);
  }
  return quads;
}

WindowQuad draw_stress(StressFamily family, StressDrawing& drawing, int width, int height) {
  stress::check_arguments(drawing.knob, width, height);
  stress::Batch batch{stress::Numbers(drawing.seed, std::move(drawing.words)), drawing.knob, width, height, SIZE_MAX};
  stress::generators[static_cast<std::size_t>(family)].make(batch);
  drawing.words = batch.rng.take_words();
  WindowQuad quad;
  quad.vertex = batch.quads[drawing.member % batch.quads.size()];
  return quad;
}

std::vector<WindowQuad> make_stress_without_weights(StressFamily family, std::size_t count, std::uint64_t seed,
                                                    int width, int height, int attributes, double knob) {
  constexpr int weights = 4;
  check_attributes("stress", attributes, max_attribute_slots - weights);
  std::vector<WindowQuad> quads = make_stress(family, count, seed, knob, width, height, weights + attributes);
  for (WindowQuad& quad : quads)
    for (std::vector<double>& attribute : quad.attribute)
      attribute.erase(attribute.begin(), attribute.begin() + weights);
  return quads;
}

}  // namespace quadrille::golden
