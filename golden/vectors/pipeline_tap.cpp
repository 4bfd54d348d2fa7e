#include "golden/vectors/pipeline_tap.hpp"

#include "golden/scenes/stress.hpp"
#include "model/front/covered_pixels.hpp"
#include "model/front/quad_setup.hpp"
#include "model/port/snap.hpp"

#include <algorithm>

namespace quadrille::vectors {
namespace {

constexpr std::size_t quads_a_unit = 8;
constexpr std::size_t tiles_a_quad = 4;
constexpr std::size_t pixels_a_quad = 4;    ///< of those that are nothing special
constexpr std::size_t specials_a_quad = 4;  ///< singular or on a tie

/// A sample of fixed size of a stream of unknown length, each item with the same chance.
template <class T>
class Reservoir {
 public:
  Reservoir(std::size_t size, golden::Prng& prng) : size_(size), prng_(prng) {}
  void offer(const T& item) {
    ++seen_;
    if (kept_.size() < size_)
      kept_.push_back(item);
    else if (const std::uint64_t at = prng_.below(seen_); at < size_)
      kept_[at] = item;
  }
  const std::vector<T>& kept() const { return kept_; }

 private:
  std::size_t size_;
  golden::Prng& prng_;
  std::vector<T> kept_;
  std::uint64_t seen_ = 0;
};

struct Place {
  TileEntry tile;
  CoveredPixel at;
};

DrawState unit_state(std::size_t round, const Config& config) {
  DrawState state;
  state.skip &= ~std::uint32_t{skip_operands};  // a stage's vectors have what a pixel could do without
  // Every other round larger, so that tiles far from the origin and whole blocks occur.
  state.width = state.height = round % 2 == 0 ? 64 : std::min(160, 1 << config.viewport_bits);
  state.scissor_x1 = state.width;
  state.scissor_y1 = state.height;
  state.perspective = round % 4 != 3;
  state.cull = static_cast<Cull>(round % 5 == 4 ? 1 + round / 5 % 2 : 0);
  state.depth = round % 6 != 5;
  state.attributes =
      round % 3 == 2 ? static_cast<int>(round / 3) % (config.attribute_slots + 1) : config.attribute_slots;
  if (round % 4 == 1) {
    state.scissor_x0 = 5;
    state.scissor_y0 = 9;
    state.scissor_x1 -= 7;
    state.scissor_y1 -= 3;
  }
  return state;
}

void tap_quad(StageData& data, Source source, const PipelineContext& context, golden::Prng& prng,
              const StageUnderTest::Sink& sink) {
  const Config& config = context.config;
  TileWalk walk(config, context.state);
  Reservoir<TileEntry> tiles(tiles_a_quad, prng);
  Reservoir<Place> pixels(pixels_a_quad, prng), specials(specials_a_quad, prng);
  data.constants = QuadConstants(data.setup);
  walk_tiles(walk, data.setup, [&](const TileEntry& tile) {
    tiles.offer(tile);
    if (source != Source::pixels) return;
    for_each_covered_pixel(tile, data.constants, config, context.state, [&](const CoveredPixel& at) {
      PixelTrace p;
      forward_difference(p, tile, data.constants, at.dx, at.row);
      normalise(p, context);
      const bool special = at.tie || p.two_corner || p.on_vertex || p.two_edge || p.on_edge;
      (special ? specials : pixels).offer({tile, at});
    });
  });
  if (source == Source::tiles) {
    for (const TileEntry& tile : tiles.kept()) {
      data.tile = tile;
      data.tile_column = tile.tile_x - data.setup.tile_x0;
      data.tile_row = tile.tile_y - data.setup.tile_y0;
      sink(data);
    }
    return;
  }
  data.data = quad_data(data.quad, data.setup, config, context.state);
  for (const Reservoir<Place>* places : {&pixels, &specials}) {
    for (const Place& place : places->kept()) {
      data.tile = place.tile;
      data.dx = place.at.dx;
      data.row = place.at.row;
      data.pixel = {};
      data.pixel.front = place.at.front;
      data.pixel.tie = place.at.tie;
      pixel_pipeline(data.pixel, place.tile, data.constants, data.data, place.at.dx, place.at.row, context);
      const PixelTrace& p = data.pixel;
      for (std::size_t i = 0; i < 4; ++i) {
        data.a_sign[i] = static_cast<std::int8_t>((p.a[i] > 0) - (p.a[i] < 0));
        data.d_negative[i] = p.d[i] < 0;
        data.corner[i] = p.r2[i] <= 0;
      }
      data.number = prng.chance(0.5) ? p.den_k : p.den_w;
      sink(data);
    }
  }
}

}  // namespace

std::size_t tap_families() { return golden::stress_families().size(); }

void tap_pipeline(std::size_t unit, std::uint64_t seed, Source source, const Config& config,
                  const StageUnderTest::Sink& sink) {
  const std::size_t families = tap_families(), round = unit / families;
  const DrawState state = unit_state(round, config);
  const PipelineContext context(config, state);
  golden::Prng prng(seed, 0x7a90000 + unit);
  const std::vector<WindowQuad> quads =
      golden::make_stress(golden::stress_families()[unit % families].family, quads_a_unit, prng.next(), 1.0,
                          state.width, state.height, config.attribute_slots);
  for (const WindowQuad& given : quads) {
    StageData data;
    data.state = state;
    data.znear = context.znear;
    data.zfar = context.zfar;
    if (source == Source::given) {
      data.vertex = given.vertex;
      for (std::size_t i = 0; i < 4; ++i) std::ranges::copy(given.attribute[i], data.attribute[i].begin());
      sink(data);
      continue;
    }
    data.quad = snap_quad(given, config, state);
    data.setup = quad_setup(data.quad, config, state);
    if (source == Source::quads)
      sink(data);
    else
      tap_quad(data, source, context, prng, sink);
  }
}

}  // namespace quadrille::vectors
