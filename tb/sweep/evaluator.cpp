#include "tb/sweep/evaluator.hpp"

#include "model/port/snap.hpp"
#include "model/skips/plane_quad.hpp"
#include "model/support/parallel.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/support/stopwatch.hpp"
#include "tb/sweep/stage_tree.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace quadrille::sweep {
namespace {

using Path = std::array<std::size_t, level_count>;
using DifferenceKey = std::pair<LevelKey, LevelKey>;

void count(StageCounters& counters, Stage stage, std::uint64_t fragments) {
  ++counters.settings[static_cast<std::size_t>(stage)];
  counters.fragments[static_cast<std::size_t>(stage)] += fragments;
}

ErrorSummary summary(const tb::ErrorStats& stats) {
  return {stats.count(), stats.max(), stats.p999(), stats.rms(), stats.mean()};
}

/// Names of nodes in the order in which the list of points first meets them.
class NodeNames {
 public:
  Path path(const Config& config) {
    Path path;
    std::size_t node = 0;
    for (std::size_t level = 0; level < level_count; ++level) {
      const std::pair key(node, level_key(config, static_cast<Level>(level)));
      node = names_.emplace(key, names_.size() + 1).first->second;
      path[level] = node;
    }
    return path;
  }

 private:
  std::map<std::pair<std::size_t, LevelKey>, std::size_t> names_;
};

/// Cuts the points, sorted by path, into batches: whole subtrees side by side up to the limit, a subtree above it at
/// its own children.
class BatchPlan {
 public:
  BatchPlan(std::span<const Path> paths, std::span<const std::size_t> sorted, std::size_t limit)
      : paths_(paths), sorted_(sorted), limit_(std::max<std::size_t>(1, limit)) {
    // Never across difference settings: their data is what a batch works on.
    constexpr auto difference = static_cast<std::size_t>(Level::differences);
    for_each_child(0, sorted_.size(), difference, [&](std::size_t first, std::size_t last) {
      place(first, last, difference + 1);
      close(last);
    });
  }

  std::vector<std::span<const std::size_t>> batches;

 private:
  /// Ranges of [first, last) that agree at `level` (and, being sorted, at all before).
  template <class F>
  void for_each_child(std::size_t first, std::size_t last, std::size_t level, F&& f) {
    while (first < last) {
      std::size_t end = first + 1;
      while (end < last && paths_[sorted_[end]][level] == paths_[sorted_[first]][level]) ++end;
      f(first, end);
      first = end;
    }
  }

  /// [first, last) agrees before `level`.
  void place(std::size_t first, std::size_t last, std::size_t level) {
    for_each_child(first, last, level, [&](std::size_t child, std::size_t end) {
      if (end - child > limit_ && level + 1 < level_count) {
        place(child, end, level + 1);
        return;
      }
      if (end - open_ > limit_) close(child);
    });
  }

  void close(std::size_t at) {
    if (at > open_) batches.push_back(sorted_.subspan(open_, at - open_));
    open_ = at;
  }

  std::span<const Path> paths_;
  std::span<const std::size_t> sorted_;
  std::size_t limit_, open_ = 0;
};

}  // namespace

struct Evaluator::Impl {
  struct Positions {
    std::shared_ptr<const PositionData> data;
    std::map<LevelKey, std::shared_ptr<const PortQuads>> ports;    ///< by port_key()
    std::map<LevelKey, std::shared_ptr<const PlaneQuads>> planes;  ///< likewise
    std::uint64_t used = 0;

    std::size_t bytes() const {
      std::size_t sum = data->bytes();
      for (const auto& [s, port] : ports) sum += port->bytes();
      for (const auto& [key, quads] : planes) sum += quads->bytes();
      return sum;
    }
  };
  struct Differences {
    std::shared_ptr<const DifferenceData> data;
    std::uint64_t used = 0;
  };

  const SweepInput& input;
  Settings settings;
  StageCounters counters;

  std::optional<GivenTruth> given;
  std::map<LevelKey, Positions> positions;
  std::map<DifferenceKey, Differences> differences;
  std::map<CyclesKey, std::uint64_t> cycles;
  std::map<std::pair<LevelKey, LevelKey>, std::string> snap_refusals;  ///< by positions and port_key()
  std::uint64_t clock = 0;                                             ///< of uses
  TableCache tables;

  Impl(const SweepInput& i, const Settings& s) : input(i), settings(s) { settings.threads = std::max(1u, s.threads); }

  std::string snap_refusal(const Config& config) {
    const std::pair key(level_key(config, Level::positions), port_key(config));
    const auto [entry, isnew] = snap_refusals.try_emplace(key);
    if (!isnew) return entry->second;
    try {
      for (std::size_t q = 0; q < input.quads.size(); ++q)
        PortQuad(input.quads[q], q, static_cast<std::size_t>(input.attributes), config, input.state);
    } catch (const SnapError& error) {
      entry->second = error.what();
    }
    return entry->second;
  }

  /// Why a configuration cannot draw the input; empty if it can.
  std::string refusal(const Config& config) {
    const int limit = 1 << config.viewport_bits;
    if (input.state.width > limit || input.state.height > limit)
      return "a viewport of " + std::to_string(input.state.width) + "x" + std::to_string(input.state.height) +
             " pixels does not fit viewport_bits = " + std::to_string(config.viewport_bits);
    if (config.quad_id_bits < 32 && input.quads.size() > std::size_t{1} << config.quad_id_bits)
      return std::to_string(input.quads.size()) +
             " quads are more than quad_id_bits = " + std::to_string(config.quad_id_bits) + " can number";
    try {
      tables.sqrt(config);
      tables.recip(config);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return snap_refusal(config);
  }

  /// Drops what was used longest ago, but nothing that was used since `keep`.
  void fit_memory(std::uint64_t keep) {
    for (;;) {
      std::size_t sum = given ? given->bytes() : 0;
      auto oldest_positions = positions.end();
      auto oldest_differences = differences.end();
      for (auto p = positions.begin(); p != positions.end(); ++p) {
        sum += p->second.bytes();
        if (p->second.used < keep &&
            (oldest_positions == positions.end() || p->second.used < oldest_positions->second.used))
          oldest_positions = p;
      }
      for (auto d = differences.begin(); d != differences.end(); ++d) {
        sum += d->second.data->bytes();
        if (d->second.used < keep &&
            (oldest_differences == differences.end() || d->second.used < oldest_differences->second.used))
          oldest_differences = d;
      }
      if (sum <= settings.memory_bytes) return;
      const bool has_positions = oldest_positions != positions.end();
      const bool has_differences = oldest_differences != differences.end();
      if (has_differences && (!has_positions || oldest_differences->second.used <= oldest_positions->second.used))
        differences.erase(oldest_differences);
      else if (has_positions)
        positions.erase(oldest_positions);
      else
        return;
    }
  }

  std::shared_ptr<const PositionData> position_data(const Config& config, StageCounters& executed) {
    if (!given) {
      given.emplace(input, settings.threads);
      count(executed, Stage::given_truth, given->pixels());
    }
    const LevelKey key = level_key(config, Level::positions);
    if (!positions.contains(key)) {
      auto data = std::make_shared<PositionData>(input, *given, config, settings.threads);
      count(executed, Stage::snap_truth, data->fragments);
      positions[key].data = std::move(data);
    }
    positions[key].used = ++clock;
    return positions[key].data;
  }

  std::shared_ptr<const DifferenceData> difference_data(const PositionData& at, const Config& config,
                                                        StageCounters& executed) {
    const DifferenceKey key(level_key(config, Level::positions), level_key(config, Level::differences));
    if (!differences.contains(key)) {
      auto data = std::make_shared<DifferenceData>(at, config, input.state, settings.threads);
      count(executed, Stage::difference, at.fragments);
      differences[key].data = std::move(data);
    }
    differences[key].used = ++clock;
    return differences[key].data;
  }

  std::shared_ptr<const PortQuads> port_quads(const Config& config) {
    Positions& entry = positions.at(level_key(config, Level::positions));
    std::shared_ptr<const PortQuads>& port = entry.ports[port_key(config)];
    if (!port) port = std::make_shared<PortQuads>(input, *given, *entry.data, config, settings.threads);
    return port;
  }

  /// None where the configuration, or the draw, has mean value weights alone.
  std::shared_ptr<const PlaneQuads> plane_quads(const Config& config) {
    if (!takes_plane_quads(config, input.state)) return nullptr;
    Positions& entry = positions.at(level_key(config, Level::positions));
    std::shared_ptr<const PlaneQuads>& quads = entry.planes[port_key(config)];
    if (!quads) quads = std::make_shared<PlaneQuads>(input, *entry.data, config, settings.threads);
    return quads;
  }

  /// The tree of some points that share a difference setting.
  StageTree tree(std::span<const Config> points, std::span<const std::size_t> batch, StageCounters& executed) {
    const Config& first = points[batch.front()];
    const std::uint64_t begin = clock + 1;
    const auto at = position_data(first, executed);
    StageTree result(input, at, difference_data(*at, first, executed));
    for (const std::size_t point : batch)
      result.add(
          point, points[point], tables, [&] { return port_quads(points[point]); },
          [&] { return plane_quads(points[point]); });
    fit_memory(begin);
    return result;
  }

  std::uint64_t clocks(const Config& config) const {
    tb::LockstepOptions options;
    options.config = widest_port(config);
    options.state = with_possible_skips(input.state, options.config);
    options.config.attribute_slots = 1;
    options.state.attributes = 0;
    // Snapped anew: the quads kept by positions have bases of another configuration's formats.
    std::vector<SnappedQuad> snapped;
    for (const WindowQuad& quad : input.quads) snapped.push_back(own_port(quad, 0, options.config, options.state));
    for (std::size_t q = 0; q < snapped.size(); ++q) snapped[q].id = static_cast<std::uint32_t>(q);
    return tb::run_clocked_model_alone(snapped, options).cycles;
  }

  CyclesKey cycles_of(const Config& config) const { return cycles_key(config, input.state); }

  Batch run(std::span<const Config> points, std::span<const std::size_t> batch,
            const std::function<void(double)>& progress) {
    const tb::Stopwatch start;
    Batch out;
    out.points.assign(batch.begin(), batch.end());
    out.results.resize(batch.size());
    const StageTree stages = tree(points, batch, out.executed);
    const auto at = positions.at(level_key(points[batch.front()], Level::positions)).data;

    // The clocked model's runs first: they are the longest units.
    std::map<CyclesKey, std::size_t> cycle_runs;
    std::vector<std::pair<std::size_t, std::uint64_t>> runs;  // point, clocks
    for (const std::size_t point : batch)
      if (settings.cycles && !cycles.contains(cycles_of(points[point])) &&
          cycle_runs.emplace(cycles_of(points[point]), runs.size()).second)
        runs.emplace_back(point, 0);

    std::vector<StageTree::ScratchPointer> scratch(settings.threads);
    const std::size_t units = runs.size() + stages.chunks();
    run_units(
        units, settings.threads,
        [&](std::size_t unit, unsigned thread) {
          if (unit < runs.size()) {
            runs[unit].second = clocks(points[runs[unit].first]);
            return;
          }
          if (!scratch[thread]) scratch[thread] = stages.make_scratch();
          stages.walk(unit - runs.size(), *scratch[thread]);
        },
        [&](std::size_t done) { progress(static_cast<double>(done) / static_cast<double>(units)); });

    out.executed += stages.executed();
    for (const auto& [key, run] : cycle_runs) {
      cycles[key] = runs[run].second;
      count(out.executed, Stage::cycles, runs[run].second);
    }
    std::map<std::size_t, std::size_t> place;
    for (std::size_t n = 0; n < batch.size(); ++n) place[batch[n]] = n;
    stages.for_each_leaf([&](const PlaneNode& leaf, const PortQuads& port) {
      LeafTotals totals;
      for (const StageTree::ScratchPointer& part : scratch)
        if (part) totals.merge(StageTree::totals(*part, leaf.leaf));
      PointResult result;
      result.fragments = totals.fragments;
      for (std::size_t q = 0; q < outputs.size(); ++q) {
        result.snapping[q] = summary(port.snapping()[q]);
        result.arithmetic[q] = summary(totals.arithmetic[q]);
      }
      result.coverage_gained = totals.fragments - totals.drawn_as_given;
      result.coverage_lost = given->pixels() - totals.drawn_as_given;
      result.discard_differs = totals.discard_differs;
      result.colour_codes = totals.colour_codes;
      result.saturated = totals.saturated;
      result.quads = at->covering;
      result.plane_quads = leaf.quads ? leaf.quads->count() : 0;
      result.plane_fragments = totals.plane_fragments;
      result.worst = totals.worst;
      result.attribute_spread = port.spread().attribute;
      result.depth_spread = port.spread().depth.value_or(std::numeric_limits<double>::infinity());
      for (const std::size_t point : leaf.points) {
        result.cycles = settings.cycles ? cycles.at(cycles_of(points[point])) : 0;
        out.results[place[point]] = result;
      }
    });
    out.seconds = start.seconds();
    return out;
  }
};

bool OrdinaryInput::operator()(const Config& config) {
  const std::lock_guard lock(mutex_);
  const auto [found, unknown] = known_.try_emplace(level_key(config, Level::positions), false);
  if (unknown) {
    DrawState state = input_.state;
    state.attributes = 0;
    const auto ordinary = [&](const WindowQuad& quad) {
      return has_ordinary_vertices(own_port(quad, 0, config, state), config);
    };
    try {
      found->second = std::ranges::all_of(input_.quads, ordinary);
    } catch (const SnapError&) {  // is refused by the evaluator
    }
  }
  return found->second;
}

Evaluator::Evaluator(const SweepInput& input, const Settings& settings)
    : impl_(std::make_unique<Impl>(input, settings)) {}
Evaluator::~Evaluator() = default;

const StageCounters& Evaluator::counters() const { return impl_->counters; }

void Evaluator::evaluate(std::span<const Config> points, const std::function<void(const Batch&)>& done,
                         const std::function<void(double)>& progress) {
  Impl& m = *impl_;
  const auto show = [&](double finished) {
    if (progress) progress(finished / static_cast<double>(points.size()));
  };
  Batch refused;
  std::vector<std::size_t> sorted;
  std::vector<Path> paths(points.size());
  NodeNames names;
  for (std::size_t point = 0; point < points.size(); ++point) {
    if (std::string why = m.refusal(points[point]); !why.empty()) {
      refused.points.push_back(point);
      refused.results.emplace_back().refused = std::move(why);
    } else {
      sorted.push_back(point);
      paths[point] = names.path(points[point]);
    }
  }
  std::size_t finished = 0;
  const auto deliver = [&](const Batch& batch) {
    m.counters += batch.executed;
    finished += batch.points.size();
    done(batch);
    show(static_cast<double>(finished));
  };
  if (!refused.points.empty()) deliver(refused);
  std::stable_sort(sorted.begin(), sorted.end(), [&](std::size_t a, std::size_t b) { return paths[a] < paths[b]; });
  const BatchPlan plan(paths, sorted, m.settings.batch_points);
  for (const std::span<const std::size_t> batch : plan.batches)
    deliver(m.run(points, batch, [&](double part) {
      show(static_cast<double>(finished) + part * static_cast<double>(batch.size()));
    }));
}

PointResult Evaluator::evaluate(const Config& point) {
  PointResult result;
  evaluate(std::span(&point, 1), [&](const Batch& batch) { result = batch.results.front(); });
  return result;
}

std::string Evaluator::refusal(const Config& point) { return impl_->refusal(point); }

std::vector<float> Evaluator::error_map(const Config& point) {
  Impl& m = *impl_;
  const DrawState& state = m.input.state;
  std::vector<float> out(static_cast<std::size_t>(state.width) * static_cast<std::size_t>(state.height), -1.0f);
  if (!m.refusal(point).empty()) return out;
  const std::size_t only = 0;
  StageCounters executed;
  const StageTree stages = m.tree(std::span(&point, 1), std::span(&only, 1), executed);
  const auto at = m.positions.at(level_key(point, Level::positions)).data;
  std::vector<float> lane_errors(at->blocks() * lane_count);
  std::vector<StageTree::ScratchPointer> scratch(m.settings.threads);
  run_units(stages.chunks(), m.settings.threads, [&](std::size_t chunk, unsigned thread) {
    if (!scratch[thread]) scratch[thread] = stages.make_scratch();
    stages.walk(chunk, *scratch[thread], lane_errors);
  });
  executed += stages.executed();
  m.counters += executed;
  for (std::size_t block = 0; block < at->blocks(); ++block)
    for (std::size_t lane = 0; lane < at->count[block]; ++lane) {
      const std::uint32_t pixel = at->pixel[block][lane];
      float& place = out[static_cast<std::size_t>(pixel_y(pixel)) * static_cast<std::size_t>(state.width) +
                         static_cast<std::size_t>(pixel_x(pixel))];
      place = std::max(place, lane_errors[block * lane_count + lane]);
    }
  return out;
}

}  // namespace quadrille::sweep
