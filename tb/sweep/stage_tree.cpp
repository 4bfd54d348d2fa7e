#include "tb/sweep/stage_tree.hpp"

#include "model/port/stages.hpp"
#include "tb/sweep/work_units.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

// Vectors wider than some targets' registers stay inside functions here.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace quadrille::sweep {
namespace {

/// Blocks of a chunk: the results between the stages fit the second-level cache.
constexpr std::size_t blocks_per_chunk = 64;

template <class Node>
Node* find(std::vector<Node>& nodes, const LevelKey& key) {
  const auto found = std::find_if(nodes.begin(), nodes.end(), [&](const Node& n) { return n.key == key; });
  return found == nodes.end() ? nullptr : &*found;
}

auto order(const WorstPixel& p) { return std::tuple(p.index, p.y, p.x); }

/// 8-bit code of a channel, to nearest; NaN gives 0.
LaneIntegers colour_code(const LaneReals& v) {
  const LaneReals low = v < 1 ? v : LaneReals{} + 1.0;
  const LaneReals clamped = v > 0 ? low : LaneReals{};
  using Codes = std::int32_t __attribute__((vector_size(4 * lane_count)));
  return __builtin_convertvector(__builtin_convertvector(clamped * 255.0 + 0.5, Codes), LaneIntegers);
}

bool takes(const PlaneNode& node) { return node.quads && node.quads->count() != 0; }

LaneReals magnitude(const LaneReals& v) { return (LaneReals)((LaneIntegers)v & INT64_MAX); }

}  // namespace

bool ReciprocalNode::takes_quads() const { return std::ranges::any_of(planes, takes); }

void LeafTotals::merge(const LeafTotals& other) {
  fragments += other.fragments;
  drawn_as_given += other.drawn_as_given;
  discard_differs += other.discard_differs;
  colour_codes += other.colour_codes;
  saturated += other.saturated;
  plane_fragments += other.plane_fragments;
  for (std::size_t q = 0; q < arithmetic.size(); ++q) arithmetic[q].merge(other.arithmetic[q]);
  const WorstPixel& w = other.worst;
  if (w.any && (!worst.any || w.error > worst.error || (w.error == worst.error && order(w) < order(worst)))) worst = w;
}

std::shared_ptr<const LaneTable> TableCache::sqrt(const Config& config) {
  const LevelKey key{config.significand_bits, config.sqrt_segments(), config.sqrt_degree};
  if (const auto* found = find(sqrt_, key)) return found->value;
  return sqrt_.emplace_back(key, std::make_shared<LaneTable>(make_sqrt_table(config))).value;
}

std::shared_ptr<const LaneTable> TableCache::recip(const Config& config) {
  const LevelKey key{config.significand_bits, config.recip_segments(), config.recip_degree};
  if (const auto* found = find(recip_, key)) return found->value;
  return recip_.emplace_back(key, std::make_shared<LaneTable>(make_recip_table(config))).value;
}

std::shared_ptr<const PipelineContext> TableCache::context(const Config& config, const DrawState& state) {
  const LevelKey key{config.significand_bits, config.sqrt_segments(), config.sqrt_degree};
  if (const auto* found = find(context_, key)) return found->value;
  return context_.emplace_back(key, std::make_shared<PipelineContext>(config, state)).value;
}

/// A chunk from its weights on: of mean value weights, or of areas in their place.
struct StageTree::Weighted {
  std::vector<WeightLanes> weights;
  std::vector<LaneColumn> sums;
  std::vector<ReciprocalLanes> reciprocals;
  std::vector<LaneColumn> values;
  std::vector<LaneMasks> masks;

  void make(std::size_t columns) {
    weights.resize(blocks_per_chunk);
    sums.resize(blocks_per_chunk * sums_per_block(columns));
    reciprocals.resize(blocks_per_chunk);
    values.resize(blocks_per_chunk * (1 + columns));
    masks.resize(blocks_per_chunk);
  }
};

/// A chunk by exact arithmetic, on the quads of one PortNode.
struct StageTree::Truth {
  std::vector<LaneReals> values;
  std::vector<LaneIntegers> codes{3 * blocks_per_chunk};
  std::vector<std::uint8_t> draws, measured;

  explicit Truth(const Columns& columns)
      : values(blocks_per_chunk * truth_per_block(columns)), draws(blocks_per_chunk), measured(blocks_per_chunk) {}
};

struct StageTree::Scratch {
  std::vector<LeafTotals> totals;
  std::vector<NormalisedLanes> normalised{blocks_per_chunk};
  std::vector<SqrtLanes> root{blocks_per_chunk};
  std::vector<RatioLanes> ratios{blocks_per_chunk};
  Weighted mean, areas;       ///< `areas` is made where a point draws a quad so
  std::vector<Truth> truths;  ///< by PortNode

  Scratch(std::size_t leaves, const Columns& columns) : totals(leaves) { mean.make(columns.count()); }
};

StageTree::StageTree(const SweepInput& input, std::shared_ptr<const PositionData> positions,
                     std::shared_ptr<const DifferenceData> differences)
    : input_(input),
      columns_{static_cast<std::size_t>(input.attributes)},
      positions_(std::move(positions)),
      differences_(std::move(differences)) {}

void StageTree::add(std::size_t point, const Config& config, TableCache& tables,
                    const std::function<std::shared_ptr<const PortQuads>()>& port,
                    const std::function<std::shared_ptr<const PlaneQuads>()>& planes) {
  const auto key = [&](Level level) { return level_key(config, level); };
  NormaliseNode* normalise = find(roots_, key(Level::normalise));
  if (!normalise) normalise = &roots_.emplace_back(key(Level::normalise), config.significand_bits);
  PortNode* numbers = find(normalise->ports, key(Level::interpolate));
  if (!numbers) {
    const DrawState& state = input_.state;
    const LaneOutputFormat format{
        config.attribute_int_bits,       config.attribute_frac(),       config.depth_bits, state.depth,
        depth_code(state.znear, config), depth_code(state.zfar, config)};
    numbers = &normalise->ports.emplace_back(key(Level::interpolate), port(), format);
  }
  SqrtNode* sqrt = find(normalise->sqrts, key(Level::sqrt));
  if (!sqrt)
    sqrt = &normalise->sqrts.emplace_back(key(Level::sqrt), tables.sqrt(config), tables.context(config, input_.state));
  RatioNode* ratio = find(sqrt->ratios, key(Level::ratios));
  if (!ratio) ratio = &sqrt->ratios.emplace_back(key(Level::ratios), config.align_guard_bits);
  InterpolateNode* interpolate = find(ratio->interpolates, key(Level::interpolate));
  if (!interpolate) {
    const auto place = static_cast<std::size_t>(numbers - normalise->ports.data());
    interpolate = &ratio->interpolates.emplace_back(key(Level::interpolate), place);
  }
  ReciprocalNode* reciprocal = find(interpolate->reciprocals, key(Level::reciprocal));
  if (!reciprocal) reciprocal = &interpolate->reciprocals.emplace_back(key(Level::reciprocal), tables.recip(config));
  PlaneNode* plane = find(reciprocal->planes, key(Level::plane));
  if (!plane) {
    plane = &reciprocal->planes.emplace_back(key(Level::plane), planes(), leaves_++);
    if (takes(*plane)) {
      const std::vector<std::uint8_t>& taken = plane->quads->taken();
      normalise->areas.resize(taken.size());
      for (std::size_t q = 0; q < taken.size(); ++q) normalise->areas[q] |= taken[q];
    }
  }
  plane->points.push_back(point);
}

std::size_t StageTree::chunks() const { return units_of(positions_->blocks(), blocks_per_chunk); }

StageTree::ScratchPointer StageTree::make_scratch() const { return ScratchPointer(new Scratch(leaves_, columns_)); }

void StageTree::ScratchDeleter::operator()(Scratch* scratch) const { delete scratch; }

const LeafTotals& StageTree::totals(const Scratch& scratch, std::size_t leaf) { return scratch.totals[leaf]; }

void StageTree::walk(std::size_t chunk, Scratch& t, std::span<float> map) const {
  const std::size_t first = chunk * blocks_per_chunk;
  const std::size_t count = std::min(blocks_per_chunk, positions_->blocks() - first);
  const std::span differences(differences_->blocks.data() + first, count);
  const std::uint32_t* quad = positions_->quad.data() + first;
  const std::size_t columns = columns_.count();

  for (const NormaliseNode& normalise : roots_) {
    const int s = normalise.significand_bits;
    while (t.truths.size() < normalise.ports.size()) t.truths.emplace_back(columns_);
    for (std::size_t port = 0; port < normalise.ports.size(); ++port) {
      Truth& truth = t.truths[port];
      normalise.ports[port].quads->truth(input_, *positions_, first, count, truth.values.data(), truth.draws.data(),
                                         truth.measured.data());
      for (std::size_t n = 0; n < count; ++n)
        for (std::size_t channel = 0; channel < 3; ++channel)
          truth.codes[3 * n + channel] =
              colour_code(truth.values[n * truth_per_block(columns_) + 1 + columns_.first_colour() + channel]);
    }
    normalise_blocks(differences, s, differences_->quadratic_bias, t.normalised.data());
    const std::vector<Run> runs = area_runs(normalise, first, count);
    if (!runs.empty()) t.areas.make(columns);
    const Run whole{0, count};
    const auto interpolate = [&](Weighted& by, const Run& run, const PortNode& port, int g) {
      interpolate_blocks({by.weights.data() + run.first, run.count}, quad + run.first, port.quads->machine(), columns,
                         input_.state.depth, s, g, by.sums.data() + run.first * sums_per_block(columns));
    };
    const auto reciprocals = [&](Weighted& by, const Run& run, const LaneTable& table) {
      reciprocal_blocks(run.count, by.sums.data() + run.first * sums_per_block(columns), columns, s, table,
                        by.reciprocals.data() + run.first);
    };
    const auto output = [&](Weighted& by, const Run& run, const PortNode& port) {
      output_blocks(run.count, by.sums.data() + run.first * sums_per_block(columns), by.reciprocals.data() + run.first,
                    quad + run.first, port.quads->machine(), columns, port.format,
                    by.values.data() + run.first * (1 + columns), by.masks.data() + run.first);
    };
    for (const SqrtNode& sqrt : normalise.sqrts) {
      sqrt_blocks({t.normalised.data(), count}, s, *sqrt.table, t.root.data());
      for (const RatioNode& ratio : sqrt.ratios) {
        const int g = ratio.align_guard_bits;
        ratio_blocks({t.normalised.data(), count}, t.root.data(), s, g, t.ratios.data());
        weight_blocks(differences, t.ratios.data(), s, g, *sqrt.table, t.mean.weights.data());
        singular_pixels(normalise, sqrt, ratio, first, count, t);
        for (const Run& run : runs) area_weights(run, first, t);
        for (const InterpolateNode& node : ratio.interpolates) {
          const PortNode& port = normalise.ports[node.port];
          interpolate(t.mean, whole, port, g);
          for (const Run& run : runs) interpolate(t.areas, run, port, g);
          for (const ReciprocalNode& reciprocal : node.reciprocals) {
            reciprocals(t.mean, whole, *reciprocal.table);
            output(t.mean, whole, port);
            if (reciprocal.takes_quads())
              for (const Run& run : runs) {
                reciprocals(t.areas, run, *reciprocal.table);
                output(t.areas, run, port);
              }
            for (const PlaneNode& plane : reciprocal.planes)
              compare(t.totals[plane.leaf], plane.quads.get(), t.truths[node.port], first, count, t, map);
          }
        }
      }
    }
  }
}

void StageTree::area_weights(const Run& run, std::size_t first, Scratch& t) const {
  area_blocks({differences_->blocks.data() + first + run.first, run.count}, t.normalised.data() + run.first,
              t.areas.weights.data() + run.first);
  // Pixels on an edge or a corner have the same weights either way.
  for (std::size_t n = run.first; n < run.first + run.count; ++n)
    for (unsigned rest = differences_->singular[first + n]; rest != 0; rest &= rest - 1)
      for (std::size_t i = 0; i < 4; ++i) {
        const int lane = std::countr_zero(rest);
        t.areas.weights[n].m[i][lane] = t.mean.weights[n].m[i][lane];
      }
}

void StageTree::singular_pixels(const NormaliseNode& normalise, const SqrtNode& sqrt, const RatioNode& ratio,
                                std::size_t first, std::size_t count, Scratch& t) const {
  std::unique_ptr<PipelineContext> context;
  for (std::size_t n = 0; n < count; ++n)
    for (unsigned rest = differences_->singular[first + n]; rest != 0; rest &= rest - 1) {
      if (!context) {
        context = std::make_unique<PipelineContext>(*sqrt.context);
        context->format.g = ratio.align_guard_bits;
      }
      singular_weights(differences_->blocks[first + n], static_cast<std::size_t>(std::countr_zero(rest)),
                       normalise.ports.front().quads->quad_data(positions_->quad[first + n]), *context,
                       t.mean.weights[n]);
    }
}

std::vector<StageTree::Run> StageTree::area_runs(const NormaliseNode& normalise, std::size_t first,
                                                 std::size_t count) const {
  std::vector<Run> runs;
  if (normalise.areas.empty()) return runs;
  for (std::size_t n = 0; n < count; ++n) {
    if (normalise.areas[positions_->quad[first + n]] == 0) continue;
    if (!runs.empty() && runs.back().first + runs.back().count == n)
      ++runs.back().count;
    else
      runs.push_back({n, 1});
  }
  return runs;
}

void StageTree::compare(LeafTotals& leaf, const PlaneQuads* areas, const Truth& exact, std::size_t first,
                        std::size_t count, const Scratch& t, std::span<float> map) const {
  const std::size_t columns = columns_.count();
  const auto stats = [&](Output q) -> tb::ErrorStats& { return leaf.arithmetic[static_cast<std::size_t>(q)]; };
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t block = first + n;
    const unsigned used = (1u << positions_->count[block]) - 1;
    // Weights and colours are passes of their own, in which no quad is plane; of a taken quad they lie in [0, 1]
    // but for rounding and saturate in neither.
    const bool plane = areas && areas->taken()[positions_->quad[block]] != 0;
    const Weighted& by = plane ? t.areas : t.mean;
    const LaneMasks& masks = by.masks[n];
    const unsigned drawn = masks.drawn & used;
    const unsigned measured = drawn & exact.measured[n];
    leaf.fragments += static_cast<unsigned>(std::popcount(drawn));
    leaf.drawn_as_given += static_cast<unsigned>(std::popcount(drawn & positions_->given[block]));
    leaf.discard_differs += static_cast<unsigned>(std::popcount((drawn ^ exact.draws[n]) & used));
    leaf.saturated += static_cast<unsigned>(std::popcount(drawn & masks.saturated));
    if (plane) leaf.plane_fragments += static_cast<unsigned>(std::popcount(drawn));

    const LaneColumn* value = t.mean.values.data() + n * (1 + columns);
    const LaneColumn* own = by.values.data() + n * (1 + columns);
    const LaneReals* truth = exact.values.data() + n * truth_per_block(columns_);
    const auto add = [&](tb::ErrorStats& to, const LaneReals& error) {
      for (unsigned rest = measured; rest != 0; rest &= rest - 1)
        to.add(error[static_cast<std::size_t>(std::countr_zero(rest))]);
    };
    if (input_.state.depth) add(stats(Output::depth), own[0].v - truth[0]);
    LaneReals largest{};
    for (std::size_t j = 0; j < Columns::first_attribute; ++j) {
      const LaneReals error = magnitude(value[1 + j].v - truth[1 + j]);
      largest = error > largest ? error : largest;
      add(stats(Output::weight), error);
    }
    for (std::size_t j = Columns::first_attribute; j < columns_.first_colour(); ++j)
      add(stats(Output::attribute), own[1 + j].v - truth[1 + j]);
    LaneIntegers codes{};  // −1 per channel that differs
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const std::size_t j = columns_.first_colour() + channel;
      add(stats(Output::colour), value[1 + j].v - truth[1 + j]);
      codes += colour_code(value[1 + j].v) != exact.codes[3 * n + channel];
    }
    for (unsigned rest = measured; rest != 0; rest &= rest - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
      leaf.colour_codes += static_cast<std::uint64_t>(-codes[lane]);
      // A thread's chunks rise, so of equal errors the first stays.
      if (leaf.worst.any && !(largest[lane] > leaf.worst.error)) continue;
      const std::uint32_t pixel = positions_->pixel[block][lane];
      leaf.worst = {true, positions_->quad[block], pixel_x(pixel), pixel_y(pixel), largest[lane]};
    }
    for (std::size_t lane = 0; !map.empty() && lane < lane_count; ++lane)
      map[block * lane_count + lane] = (drawn >> lane & 1) == 0      ? -1.0f
                                       : (measured >> lane & 1) == 0 ? 0.0f
                                                                     : static_cast<float>(largest[lane]);
  }
}

StageCounters StageTree::executed() const {
  StageCounters out;
  const auto count = [&](Stage stage) {
    ++out.settings[static_cast<std::size_t>(stage)];
    out.fragments[static_cast<std::size_t>(stage)] += positions_->fragments;
  };
  for (const NormaliseNode& normalise : roots_) {
    count(Stage::normalise);
    std::uint64_t area_fragments = 0;
    if (!normalise.areas.empty())
      for (std::size_t block = 0; block < positions_->blocks(); ++block)
        if (normalise.areas[positions_->quad[block]] != 0) area_fragments += positions_->count[block];
    for (const SqrtNode& sqrt : normalise.sqrts) {
      count(Stage::sqrt);
      for (const RatioNode& ratio : sqrt.ratios) {
        count(Stage::ratios);
        count(Stage::weights);
        for (const InterpolateNode& interpolate : ratio.interpolates) {
          count(Stage::interpolate);
          for (const ReciprocalNode& reciprocal : interpolate.reciprocals) {
            count(Stage::reciprocal);
            count(Stage::output);
            if (area_fragments == 0 || !reciprocal.takes_quads()) continue;
            ++out.settings[static_cast<std::size_t>(Stage::areas)];
            out.fragments[static_cast<std::size_t>(Stage::areas)] += area_fragments;
          }
        }
      }
    }
  }
  return out;
}

void StageTree::for_each_leaf(const std::function<void(const PlaneNode&, const PortQuads&)>& f) const {
  for (const NormaliseNode& normalise : roots_)
    for (const SqrtNode& sqrt : normalise.sqrts)
      for (const RatioNode& ratio : sqrt.ratios)
        for (const InterpolateNode& interpolate : ratio.interpolates)
          for (const ReciprocalNode& reciprocal : interpolate.reciprocals)
            for (const PlaneNode& plane : reciprocal.planes) f(plane, *normalise.ports[interpolate.port].quads);
}

}  // namespace quadrille::sweep
