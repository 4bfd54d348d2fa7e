#include "tb/sweep/port_quads.hpp"

#include "golden/reference/port_number.hpp"
#include "golden/reference/truth.hpp"
#include "model/port/draw_state.hpp"
#include "model/support/parallel.hpp"
#include "tb/sweep/work_units.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

// Vectors wider than some targets' registers stay inside functions here.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace quadrille::sweep {
namespace {

constexpr std::size_t ports_per_unit = 64;
constexpr std::size_t truths_per_unit = 256;

TruthNumbers truth_numbers(const PortQuad& quad, const Columns& columns, const Config& config, bool perspective) {
  TruthNumbers out;
  out.measured =
      perspective || std::all_of(quad.own.vertex.begin(), quad.own.vertex.end(), [](const auto& v) { return v.w > 0; });
  for (std::size_t i = 0; i < 4; ++i) {
    const SnappedVertex& v = quad.own.vertex[i];
    out.k[i] = golden::port_value(v.k, config.significand_bits);
    out.w[i] = std::ldexp(static_cast<double>(v.w), -config.frac());
    out.z[i] = golden::port_value(v.z, config.significand_bits);
    for (std::size_t j = 0; j < columns.count(); ++j)
      out.b[j][i] = golden::port_value(quad.difference(j, i, columns), config.significand_bits);
  }
  for (std::size_t j = 0; j < columns.count(); ++j)
    out.base[j] = std::ldexp(static_cast<double>(quad.base(j, columns)), -config.attribute_frac());
  const auto depth_value = [&](auto code) { return std::ldexp(static_cast<double>(code), -config.depth_bits); };
  out.depth = depth_value(quad.own.base.depth);
  out.depth_low = depth_value(quad.own.base.depth_low);
  out.depth_high = depth_value(quad.own.base.depth_high);
  return out;
}

[[gnu::always_inline]] inline LaneReals weighted(const LaneReals* m, const std::array<double, 4>& v) {
  return (m[0] * v[0] + m[1] * v[1]) + (m[2] * v[2] + m[3] * v[3]);
}

/// Differences between the values that the port's numbers stand for.
Spread spread_of(const TruthNumbers& quad, const Columns& columns, bool perspective) {
  Spread out;
  if (!quad.measured) return out;
  const auto range = [](const std::array<double, 4>& difference, const std::array<double, 4>& factor) {
    std::array<double, 4> above{};
    for (std::size_t i = 0; i < 4; ++i) above[i] = difference[i] == 0 ? 0 : difference[i] / factor[i];
    const auto [least, greatest] = std::ranges::minmax(above);
    return std::max(greatest, 0.0) - std::min(least, 0.0);  // the base counts too
  };
  for (std::size_t j = Columns::first_attribute; j < columns.first_colour(); ++j)
    out.attribute = std::max(out.attribute, range(quad.b[j], perspective ? quad.k : quad.w));
  out.depth =
      std::ranges::all_of(quad.w, [](double w) { return w > 0; }) ? std::optional(range(quad.z, quad.w)) : std::nullopt;
  return out;
}

}  // namespace

void Spread::merge(const Spread& other) {
  attribute = std::max(attribute, other.attribute);
  depth = depth && other.depth ? std::optional(std::max(*depth, *other.depth)) : std::nullopt;
}

PortQuads::PortQuads(const SweepInput& input, const GivenTruth& given, const PositionData& positions,
                     const Config& config, unsigned threads, const Stop& stop)
    : truth_(input.quads.size()),
      znear_(std::ldexp(depth_code(input.state.znear, config), -config.depth_bits)),
      zfar_(std::ldexp(depth_code(input.state.zfar, config), -config.depth_bits)) {
  const Columns columns{static_cast<std::size_t>(input.attributes)};
  DrawState state = input.state;
  state.attributes = 0;

  // Blocks of a quad are neighbours; singular ones of all quads, by block.
  std::vector<std::vector<std::size_t>> singular_blocks(input.quads.size());
  for (std::size_t block = 0; block < positions.blocks(); ++block)
    if (positions.singular[block] != 0) singular_blocks[positions.quad[block]].push_back(block);

  quads_.resize(input.quads.size());
  std::vector<std::vector<SingularPixel>> singular(input.quads.size());
  run_units(units_of(input.quads.size(), ports_per_unit), threads, [&](std::size_t unit, unsigned) {
    stop.check();
    for (std::size_t q = unit * ports_per_unit; q < std::min((unit + 1) * ports_per_unit, input.quads.size()); ++q) {
      PortQuad& port = quads_[q] = PortQuad(input.quads[q], q, columns.attributes, config, input.state);
      truth_[q] = truth_numbers(port, columns, config, input.state.perspective);
      if (singular_blocks[q].empty()) continue;
      const golden::TruthQuad exact(port.own, config, state);
      for (const std::size_t block : singular_blocks[q])
        for (unsigned rest = positions.singular[block]; rest != 0; rest &= rest - 1) {
          const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
          const int x = pixel_x(positions.pixel[block][lane]), y = pixel_y(positions.pixel[block][lane]);
          singular[q].push_back({block, lane, exact.cover(x, y).visible, {}});
          SingularPixel& p = singular[q].back();
          const auto m = exact.homogeneous_weights(x, y);
          for (std::size_t i = 0; i < 4; ++i) p.m[i] = static_cast<double>(m[i]);
        }
    }
  });
  for (std::size_t block = 0; block < positions.blocks(); ++block)
    if (block == 0 || positions.quad[block] != positions.quad[block - 1])
      spread_.merge(spread_of(truth_[positions.quad[block]], columns, input.state.perspective));
  for (const std::vector<SingularPixel>& list : singular) singular_.insert(singular_.end(), list.begin(), list.end());

  std::vector<OutputStats> parts(std::max(1u, threads));
  std::vector<std::uint64_t> drawn(parts.size());
  run_units(units_of(positions.blocks(), truths_per_unit), threads, [&](std::size_t unit, unsigned thread) {
    stop.check();
    const std::size_t first = unit * truths_per_unit;
    const std::size_t count = std::min(truths_per_unit, positions.blocks() - first);
    const std::size_t stride = truth_per_block(columns);
    std::vector<LaneReals> values(count * stride);
    std::vector<std::uint8_t> draws(count), measured(count);
    truth(input, positions, first, count, values.data(), draws.data(), measured.data());
    OutputStats& stats = parts[thread];
    const auto add = [&](Output output, double error) { stats[static_cast<std::size_t>(output)].add(error); };
    for (std::size_t n = 0; n < count; ++n) {
      drawn[thread] += static_cast<unsigned>(std::popcount(draws[n] & ((1u << positions.count[first + n]) - 1)));
      for (unsigned rest = draws[n] & measured[n] & positions.given[first + n]; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        const double* wanted = given.values(positions.given_at[first + n][lane]);
        const auto error = [&](std::size_t value) { return values[n * stride + value][lane] - wanted[value]; };
        if (input.state.depth) add(Output::depth, error(0));
        for (std::size_t j = 0; j < columns.count(); ++j)
          add(j < Columns::first_attribute ? Output::weight
              : j < columns.first_colour() ? Output::attribute
                                           : Output::colour,
              error(1 + j));
      }
    }
  });
  for (const OutputStats& part : parts)
    for (std::size_t q = 0; q < part.size(); ++q) snapping_[q].merge(part[q]);
  for (const std::uint64_t part : drawn) drawn_ += part;
}

std::size_t PortQuads::bytes() const {
  return quads_.size() * (sizeof(PortQuad) + sizeof(TruthNumbers)) + singular_.size() * sizeof(SingularPixel);
}

void PortQuads::truth(const SweepInput& input, const PositionData& positions, std::size_t first, std::size_t count,
                      LaneReals* values, std::uint8_t* draws, std::uint8_t* measured) const {
  const std::size_t columns = Columns{static_cast<std::size_t>(input.attributes)}.count();
  auto special = std::lower_bound(singular_.begin(), singular_.end(), first,
                                  [](const SingularPixel& p, std::size_t block) { return p.block < block; });
  for (std::size_t n = 0; n < count; ++n, values += 1 + columns) {
    const std::size_t block = first + n;
    TruthWeights m = positions.truth[block];
    std::uint8_t visible = positions.visible[block];
    for (; special != singular_.end() && special->block == block; ++special) {
      for (std::size_t i = 0; i < 4; ++i) m.m[i][special->lane] = special->m[i];
      const auto bit = static_cast<std::uint8_t>(1u << special->lane);
      visible = static_cast<std::uint8_t>(special->visible ? visible | bit : visible & ~bit);
    }
    const TruthNumbers& q = truth_[positions.quad[block]];
    const LaneReals sum_w = weighted(m.m, q.w);
    const std::array<double, 4>& factor = input.state.perspective ? q.k : q.w;
    const LaneReals whole = input.state.perspective ? weighted(m.m, q.k) : sum_w;
    const LaneReals z = q.depth + weighted(m.m, q.z) / sum_w;
    const LaneReals above = z < q.depth_high ? z : LaneReals{} + q.depth_high;
    values[0] = above > q.depth_low ? above : LaneReals{} + q.depth_low;
    for (std::size_t i = 0; i < 4; ++i) values[1 + i] = m.m[i] * factor[i] / whole;
    for (std::size_t j = 4; j < columns; ++j) values[1 + j] = q.base[j] + weighted(m.m, q.b[j]) / whole;
    draws[n] = visible;
    measured[n] = q.measured ? visible : 0;
    if (!input.state.depth) continue;
    for (std::size_t lane = 0; lane < lane_count; ++lane)
      if (const double at = values[0][lane]; !(at >= znear_ && at <= zfar_))
        draws[n] = static_cast<std::uint8_t>(draws[n] & ~(1u << lane));
  }
}

}  // namespace quadrille::sweep
