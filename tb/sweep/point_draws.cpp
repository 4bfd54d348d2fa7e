#include "tb/sweep/point_draws.hpp"

#include "model/port/draw_state.hpp"
#include "model/skips/plane_quad.hpp"
#include "model/untimed.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>

// Vectors wider than some targets' registers stay inside functions here.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace quadrille::sweep {
namespace {

constexpr std::size_t blocks_per_part = 1 << 13;
/// Of the truth at hand, about, where no quad has more: it fits the second-level cache.
constexpr std::size_t blocks_at_hand = 128;

auto order(const WorstPixel& p) { return std::tuple(p.index, p.y, p.x); }

void take_worst(WorstPixel& worst, const WorstPixel& other) {
  if (worst.any && (other.error < worst.error || (other.error == worst.error && order(worst) <= order(other)))) return;
  worst = other;
}

/// 8-bit code of a channel, to nearest; NaN gives 0.
int colour_code(double v) { return static_cast<int>((v > 0 ? std::min(v, 1.0) : 0.0) * 255.0 + 0.5); }

/// Exact arithmetic at some blocks.
struct Truth {
  std::size_t stride;  ///< values of a block
  std::size_t first = 0;
  std::vector<LaneReals> values;
  std::vector<std::uint8_t> draws, measured;

  void take(const SweepInput& input, const PositionData& positions, const PortQuads& port, std::size_t block,
            std::size_t count) {
    first = block;
    if (draws.size() < count) {
      values.resize(count * stride);
      draws.resize(count);
      measured.resize(count);
    }
    port.truth(input, positions, block, count, values.data(), draws.data(), measured.data());
  }
};

/// A pixel that the machine draws.
struct Drawn {
  std::uint32_t pixel;
  bool saturated;
  bool measured;
  std::size_t place;  ///< lane of the input
  const double* truth;
};

/// A configuration's two passes over a quad.
class PointMachine {
 public:
  PointMachine(const SweepInput& input, const PositionData& positions, const PointDraw& point, const DrawPart& part)
      : positions_(positions),
        columns_{static_cast<std::size_t>(input.attributes)},
        config_(widest_port(point.config)),
        own_state_(own_pass(input, config_, part)),
        test_state_(test_pass(own_state_)),
        own_(config_, own_state_),
        test_(config_, test_state_),
        attribute_unit_(std::ldexp(1.0, -config_.attribute_frac())),
        depth_unit_(std::ldexp(1.0, -config_.depth_bits)),
        totals_(*point.totals) {}

  void draw(const PortQuad& port, const Truth& truth, std::span<float> map) {
    quad_ = port.own.id;
    truth_ = &truth;
    map_ = map;
    drawn_.clear();
    next_ = positions_.first_block[quad_] * lane_count;
    own_.draw_arrays(port.own, [this](const FragmentArrays& fragments) { take_own(fragments); });
    totals_.fragments += drawn_.size();
    if (plane_quad(port.own, config_, own_state_)) {
      const int first_row = pixel_y(positions_.pixel[positions_.first_block[quad_]].front());
      totals_.plane_quads += first_row >= own_state_.scissor_y0 && first_row < own_state_.scissor_y1;
      totals_.plane_fragments += drawn_.size();
    }
    done_ = 0;
    test_.draw_arrays(port.test, [this](const FragmentArrays& fragments) { take_test(fragments); });
  }

 private:
  static DrawState own_pass(const SweepInput& input, const Config& config, const DrawPart& part) {
    DrawState state = input.state;
    state.attributes = input.attributes;
    state.scissor_y0 = std::max(state.scissor_y0, part.y0);
    state.scissor_y1 = std::min(state.scissor_y1, part.y1);
    return with_possible_skips(state, config);
  }
  /// Weights and colours: nothing is discarded that the other pass draws, and no quad is plane.
  static DrawState test_pass(DrawState state) {
    state.depth = false;
    state.skip &= ~std::uint32_t{skip_plane};
    state.attributes = 7;
    return state;
  }

  /// Lane of a pixel of the quad. Most follow the one asked for before.
  std::size_t place_of(std::uint32_t pixel) {
    const std::uint32_t* pixels = positions_.pixel.front().data();
    const std::size_t end = positions_.first_block[quad_ + 1] * lane_count;
    if (next_ >= end || pixels[next_] != pixel)
      next_ = static_cast<std::size_t>(
          std::lower_bound(pixels + positions_.first_block[quad_] * lane_count, pixels + end, pixel) - pixels);
    return next_++;
  }

  void take_own(const FragmentArrays& f) {
    const std::size_t begin = drawn_.size();
    for (std::size_t i = 0; i < f.size; ++i) {
      const std::uint32_t pixel = pack_pixel(f.place[i].x, f.place[i].y);
      const std::size_t place = place_of(pixel), block = place / lane_count, lane = place % lane_count;
      const std::size_t at = block - truth_->first;
      const bool saturated = (f.marks[i].flags & flag_saturated) != 0;
      totals_.saturated += saturated;
      totals_.drawn_as_given += positions_.given[block] >> lane & 1;
      totals_.drawn_as_snapped += truth_->draws[at] >> lane & 1;
      drawn_.push_back({pixel, saturated, (truth_->measured[at] >> lane & 1) != 0, place,
                        reinterpret_cast<const double*>(truth_->values.data() + at * truth_->stride) + lane});
    }
    const std::span<const Drawn> drawn(drawn_.data() + begin, f.size);
    if (own_state_.depth) add(Output::depth, f.depth, depth_unit_, drawn, 0);
    for (std::size_t j = 0; j < columns_.attributes; ++j)
      add(Output::attribute, f.attribute[j], attribute_unit_, drawn, 1 + Columns::first_attribute + j);
  }

  /// Errors of one column, truth's value `value` of a block.
  template <class Code>
  void add(Output output, const Code* code, double unit, std::span<const Drawn> drawn, std::size_t value) {
    tb::ErrorStats& stats = totals_.arithmetic[static_cast<std::size_t>(output)];
    for (std::size_t i = 0; i < drawn.size(); ++i)
      if (drawn[i].measured) stats.add(static_cast<double>(code[i]) * unit - drawn[i].truth[value * lane_count]);
  }

  void take_test(const FragmentArrays& f) {
    for (std::size_t i = 0; i < f.size && done_ < drawn_.size(); ++i) {
      const Drawn& at = drawn_[done_];
      if (pack_pixel(f.place[i].x, f.place[i].y) != at.pixel) continue;
      ++done_;
      totals_.saturated += (f.marks[i].flags & flag_saturated) != 0 && !at.saturated;
      if (!at.measured) {
        if (!map_.empty()) map_[at.place] = 0;
        continue;
      }
      const auto value = [&](std::size_t j) { return static_cast<double>(f.attribute[j][i]) * attribute_unit_; };
      double largest = 0;
      for (std::size_t j = 0; j < Columns::first_attribute; ++j) {
        const double error = std::fabs(value(j) - at.truth[(1 + j) * lane_count]);
        largest = error > largest ? error : largest;
        totals_.arithmetic[static_cast<std::size_t>(Output::weight)].add(error);
      }
      for (std::size_t channel = 0; channel < 3; ++channel) {
        const double exact = at.truth[(1 + columns_.first_colour() + channel) * lane_count];
        const double colour = value(Columns::first_attribute + channel);
        totals_.arithmetic[static_cast<std::size_t>(Output::colour)].add(colour - exact);
        totals_.colour_codes += colour_code(colour) != colour_code(exact);
      }
      if (!totals_.worst.any || largest >= totals_.worst.error)
        take_worst(totals_.worst, {true, quad_, pixel_x(at.pixel), pixel_y(at.pixel), largest});
      if (!map_.empty()) map_[at.place] = static_cast<float>(largest);
    }
  }

  const PositionData& positions_;
  Columns columns_;
  Config config_;
  DrawState own_state_, test_state_;
  UntimedModel own_, test_;
  double attribute_unit_, depth_unit_;
  DrawTotals& totals_;

  // Of the quad in work.
  std::uint32_t quad_ = 0;
  const Truth* truth_ = nullptr;
  std::span<float> map_;
  std::size_t next_ = 0, done_ = 0;
  std::vector<Drawn> drawn_;
};

}  // namespace

void DrawTotals::merge(const DrawTotals& other) {
  fragments += other.fragments;
  drawn_as_given += other.drawn_as_given;
  drawn_as_snapped += other.drawn_as_snapped;
  colour_codes += other.colour_codes;
  saturated += other.saturated;
  plane_quads += other.plane_quads;
  plane_fragments += other.plane_fragments;
  for (std::size_t q = 0; q < arithmetic.size(); ++q) arithmetic[q].merge(other.arithmetic[q]);
  if (other.worst.any) take_worst(worst, other.worst);
}

std::vector<DrawPart> draw_parts(const PositionData& positions, const DrawState& state) {
  std::vector<DrawPart> parts;
  const auto& first = positions.first_block;
  const auto rows_of = [&](std::size_t block, std::size_t lane) { return pixel_y(positions.pixel[block][lane]); };
  for (std::size_t q = 0, end; q + 1 < first.size(); q = end) {
    end = q + 1;
    const std::size_t blocks = first[end] - first[q];
    if (blocks > blocks_per_part) {
      const int y0 = rows_of(first[q], 0), y1 = rows_of(first[end] - 1, lane_count - 1) + 1;
      const int bands =
          static_cast<int>(std::min<std::size_t>(blocks / blocks_per_part + 1, static_cast<std::size_t>(y1 - y0)));
      for (int band = 0; band < bands; ++band)
        parts.push_back({q, end, y0 + (y1 - y0) * band / bands, y0 + (y1 - y0) * (band + 1) / bands});
      continue;
    }
    while (end + 1 < first.size() && first[end + 1] - first[q] <= blocks_per_part) ++end;
    if (first[end] != first[q]) parts.push_back({q, end, 0, state.height});
  }
  return parts;
}

void draw_points(const SweepInput& input, const PositionData& positions, const PortQuads& port,
                 std::span<const PointDraw> points, const DrawPart& part, std::span<float> map) {
  std::vector<std::unique_ptr<PointMachine>> machines;
  for (const PointDraw& point : points)
    machines.push_back(std::make_unique<PointMachine>(input, positions, point, part));
  Truth truth{truth_per_block(Columns{static_cast<std::size_t>(input.attributes)}), 0, {}, {}, {}};
  const std::uint32_t* pixels = positions.pixel.front().data();
  for (std::size_t first = part.first, end; first < part.last; first = end) {
    end = first + 1;
    while (end < part.last && positions.first_block[end + 1] - positions.first_block[first] <= blocks_at_hand) ++end;
    const std::uint32_t *begin = pixels + positions.first_block[first] * lane_count,
                        *stop = pixels + positions.first_block[end] * lane_count;
    if (end == first + 1) {  // the rows that are asked for
      begin = std::lower_bound(begin, stop, pack_pixel(0, part.y0));
      stop = std::lower_bound(begin, stop, pack_pixel(0, part.y1));
    }
    const auto block = static_cast<std::size_t>(begin - pixels) / lane_count;
    truth.take(input, positions, port, block,
               static_cast<std::size_t>(stop - pixels + lane_count - 1) / lane_count - block);
    for (const auto& machine : machines)
      for (std::size_t q = first; q < end; ++q)
        if (positions.first_block[q] != positions.first_block[q + 1]) machine->draw(port.quad(q), truth, map);
  }
}

}  // namespace quadrille::sweep
