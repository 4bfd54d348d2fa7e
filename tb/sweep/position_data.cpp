#include "tb/sweep/position_data.hpp"
#include "model/support/float113.hpp"

#include "golden/reference/truth.hpp"
#include "model/front/covered_pixels.hpp"
#include "model/front/quad_setup.hpp"
#include "model/support/parallel.hpp"
#include "tb/sweep/work_units.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace quadrille::sweep {
namespace {

constexpr std::size_t quads_per_unit = 16;
constexpr std::size_t blocks_per_unit = 64;

/// Calls f(tile, constants, dx, row) for every pixel that the machine covers, in its order.
template <class F>
void for_each_pixel(const SnappedQuad& quad, const Config& config, const DrawState& state, F&& f) {
  TileWalk walk(config, state);
  walk_tiles(walk, quad_setup(quad, config, state), [&](const TileEntry& tile) {
    for_each_covered_pixel(tile, walk.constants(), config, state,
                           [&](const CoveredPixel& at) { f(tile, walk.constants(), at.dx, at.row); });
  });
}

std::uint32_t pixel_of(const TileEntry& tile, int dx, int row, const Config& config) {
  return pack_pixel((tile.tile_x << config.tile_log2) + dx, (tile.tile_y << config.tile_log2) + row);
}

/// Truth at one block. Double is enough behind it: M_i come with 113 bits and are rounded once.
void fill_truth(PositionData& data, std::size_t block, const golden::TruthQuad& truth) {
  data.visible[block] = data.singular[block] = 0;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const std::uint32_t pixel = data.pixel[block][lane];
    if (lane >= data.count[block]) {
      for (LaneReals& m : data.truth[block].m) m[lane] = m[lane - 1];
      continue;
    }
    const golden::Coverage coverage = truth.cover(pixel_x(pixel), pixel_y(pixel));
    if (!coverage.covered) throw std::logic_error("the machine covers a pixel that exact arithmetic does not");
    const std::array<Float113, 4> m = truth.homogeneous_weights(pixel_x(pixel), pixel_y(pixel));
    Float113 size = 0;
    for (const Float113 v : m) size += v < 0 ? -v : v;
    const Float113 scale = size == 0 ? 0 : 1 / size;
    for (std::size_t i = 0; i < 4; ++i) data.truth[block].m[i][lane] = static_cast<double>(m[i] * scale);
    const unsigned bit = 1u << lane;
    if (coverage.visible) data.visible[block] |= static_cast<std::uint8_t>(bit);
    // A singular pixel lies on two edges at least, and not all of its zero edges are without direction.
    constexpr std::uint8_t classes = flag_on_vertex | flag_two_corner | flag_two_edge;
    if ((coverage.flags & flag_tie) != 0 && (truth.sample(pixel_x(pixel), pixel_y(pixel)).flags & classes) != 0)
      data.singular[block] |= static_cast<std::uint8_t>(bit);
  }
}

}  // namespace

PositionData::PositionData(const SweepInput& input, const GivenTruth& given_truth, const Config& config,
                           unsigned threads, const Stop& stop) {
  DrawState state = input.state;
  state.attributes = 0;
  for (std::size_t q = 0; q < input.quads.size(); ++q) {
    snapped.push_back(snap_quad(own_quad(input.quads[q], 0), widest_port(config), state));
    snapped.back().id = static_cast<std::uint32_t>(q);
  }

  using Lists = std::vector<std::vector<std::uint32_t>>;
  const auto cover = [&](std::size_t unit) {
    stop.check();
    Lists lists;
    for (std::size_t q = unit * quads_per_unit; q < std::min((unit + 1) * quads_per_unit, snapped.size()); ++q) {
      std::vector<std::uint32_t>& list = lists.emplace_back();
      for_each_pixel(snapped[q], config, state, [&](const TileEntry& tile, const QuadConstants&, int dx, int row) {
        list.push_back(pixel_of(tile, dx, row, config));
      });
      std::sort(list.begin(), list.end());
    }
    return lists;
  };
  const auto append = [&](std::size_t unit, const Lists& lists) {
    for (std::size_t n = 0; n < lists.size(); ++n) {
      const std::vector<std::uint32_t>& list = lists[n];
      const std::size_t q = unit * quads_per_unit + n;
      fragments += list.size();
      covering += !list.empty();
      std::size_t at = given_truth.first(q);
      const std::size_t end = given_truth.first(q + 1);
      for (std::size_t first = 0; first < list.size(); first += lane_count) {
        const std::size_t used = std::min<std::size_t>(lane_count, list.size() - first);
        quad.push_back(static_cast<std::uint32_t>(q));
        count.push_back(static_cast<std::uint8_t>(used));
        given.push_back(0);
        std::array<std::uint32_t, lane_count>& pixels = pixel.emplace_back();
        std::array<std::uint32_t, lane_count>& places = given_at.emplace_back();
        for (std::size_t lane = 0; lane < lane_count; ++lane) {
          pixels[lane] = list[first + std::min(lane, used - 1)];
          if (lane >= used) continue;
          while (at < end && given_truth.pixel(at) < pixels[lane]) ++at;
          if (at == end || given_truth.pixel(at) != pixels[lane]) continue;
          given.back() |= static_cast<std::uint8_t>(1u << lane);
          places[lane] = static_cast<std::uint32_t>(at);
        }
      }
    }
  };
  ordered_parallel(units_of(snapped.size(), quads_per_unit), threads, cover, append);

  first_block.assign(snapped.size() + 1, blocks());
  for (std::size_t block = blocks(); block-- > 0;) first_block[quad[block]] = block;
  for (std::size_t q = snapped.size(); q-- > 0;) first_block[q] = std::min(first_block[q], first_block[q + 1]);

  truth.resize(blocks());
  visible.resize(blocks());
  singular.resize(blocks());
  run_units(units_of(blocks(), blocks_per_unit), threads, [&](std::size_t unit, unsigned) {
    stop.check();
    std::size_t block = unit * blocks_per_unit;
    const std::size_t end = std::min(block + blocks_per_unit, blocks());
    while (block < end) {
      const std::uint32_t q = quad[block];
      const golden::TruthQuad exact(snapped[q], config, state);
      for (; block < end && quad[block] == q; ++block) fill_truth(*this, block, exact);
    }
  });
}

std::size_t PositionData::bytes() const {
  return snapped.size() * sizeof(SnappedQuad) +
         blocks() * (sizeof(TruthWeights) + sizeof pixel[0] + sizeof given_at[0] + sizeof quad[0] + 4);
}

}  // namespace quadrille::sweep
