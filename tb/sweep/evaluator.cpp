#include "tb/sweep/evaluator.hpp"

#include "model/drive.hpp"
#include "model/port/snap.hpp"
#include "model/port/tables.hpp"
#include "model/support/parallel.hpp"
#include "tb/support/stopwatch.hpp"
#include "tb/sweep/point_draws.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace quadrille::sweep {
namespace {

/// Of a point: its positions, its numbers at the port, what it draws. Points of one path share everything but clocks.
using Path = std::array<std::size_t, 3>;

/// Drawn together, to share the truth.
constexpr std::size_t points_per_unit = 8;

void count(StageCounters& counters, Stage stage, std::uint64_t fragments) {
  ++counters.settings[static_cast<std::size_t>(stage)];
  counters.fragments[static_cast<std::size_t>(stage)] += fragments;
}

ErrorSummary summary(const tb::ErrorStats& stats) {
  return {stats.count(), stats.max(), stats.p999(), stats.rms(), stats.mean()};
}

/// Numbers of keys in the order in which they first come.
class Names {
 public:
  std::size_t operator()(LevelKey key) { return names_.emplace(std::move(key), names_.size()).first->second; }

 private:
  std::map<LevelKey, std::size_t> names_;
};

}  // namespace

struct Evaluator::Impl {
  struct Positions {
    std::shared_ptr<const PositionData> data;
    std::map<LevelKey, std::shared_ptr<const PortQuads>> ports;  ///< by port_key()
    std::uint64_t used = 0;

    std::size_t bytes() const {
      std::size_t sum = data->bytes();
      for (const auto& [s, port] : ports) sum += port->bytes();
      return sum;
    }
  };
  const SweepInput& input;
  Settings settings;
  StageCounters counters;

  std::optional<GivenTruth> given;
  std::map<LevelKey, Positions> positions;
  std::map<CyclesKey, std::uint64_t> cycles;
  std::map<std::pair<LevelKey, LevelKey>, std::string> snap_refusals;  ///< by positions and port_key()
  std::map<std::array<LevelKey, 3>, std::string> table_refusals;       ///< by the stages that enter
  std::uint64_t clock = 0;                                             ///< of uses

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

  /// Empty if every coefficient fits.
  std::string table_refusal(const Config& config) {
    const auto key = [&](Level level) { return level_key(config, level); };
    const auto [entry, isnew] =
        table_refusals.try_emplace({key(Level::normalise), key(Level::sqrt), key(Level::reciprocal)});
    if (isnew) try {
        make_sqrt_table(config);
        make_recip_table(config);
      } catch (const ConfigError& error) {
        entry->second = error.what();
      }
    return entry->second;
  }

  /// Why a configuration cannot draw the input; empty if it can.
  std::string refusal(const Config& config) {
    settings.stop.check();
    const int limit = 1 << config.viewport_bits;
    if (input.state.width > limit || input.state.height > limit)
      return "a viewport of " + std::to_string(input.state.width) + "x" + std::to_string(input.state.height) +
             " pixels does not fit viewport_bits = " + std::to_string(config.viewport_bits);
    if (config.quad_id_bits < 32 && input.quads.size() > std::size_t{1} << config.quad_id_bits)
      return std::to_string(input.quads.size()) +
             " quads are more than quad_id_bits = " + std::to_string(config.quad_id_bits) + " can number";
    if (std::string why = table_refusal(config); !why.empty()) return why;
    return snap_refusal(config);
  }

  /// Drops the positions that were used longest ago, but those of the last batch.
  void fit_memory() {
    for (;;) {
      std::size_t sum = given ? given->bytes() : 0;
      for (const auto& [key, entry] : positions) sum += entry.bytes();
      if (sum <= settings.memory_bytes || positions.size() <= 1) return;
      positions.erase(std::ranges::min_element(positions, {}, [](const auto& entry) { return entry.second.used; }));
    }
  }

  std::shared_ptr<const PositionData> position_data(const Config& config, StageCounters& executed) {
    if (!given) {
      given.emplace(input, settings.threads, settings.stop);
      count(executed, Stage::given_truth, given->pixels());
    }
    const LevelKey key = level_key(config, Level::positions);
    if (!positions.contains(key)) {
      auto data = std::make_shared<PositionData>(input, *given, config, settings.threads, settings.stop);
      count(executed, Stage::snap_truth, data->fragments);
      positions[key].data = std::move(data);
    }
    positions[key].used = ++clock;
    return positions[key].data;
  }

  std::shared_ptr<const PortQuads> port_quads(const Config& config) {
    Positions& entry = positions.at(level_key(config, Level::positions));
    const LevelKey key = port_key(config);
    if (const auto known = entry.ports.find(key); known != entry.ports.end()) return known->second;
    const auto port =
        std::make_shared<const PortQuads>(input, *given, *entry.data, config, settings.threads, settings.stop);
    return entry.ports[key] = port;
  }

  /// Points that draw the same numbers at the port: `points` hold one of each path.
  struct Group {
    std::shared_ptr<const PortQuads> port;
    std::vector<std::size_t> points;
  };

  std::uint64_t clocks(const Config& point) const {
    Config config = widest_port(point);
    DrawState state = with_possible_skips(input.state, config);
    config.attribute_slots = 1;
    state.attributes = 0;
    // Snapped anew: the quads kept by positions have bases of another configuration's formats.
    std::vector<SnappedQuad> snapped;
    for (const WindowQuad& quad : input.quads) snapped.push_back(own_port(quad, 0, config, state));
    for (std::size_t q = 0; q < snapped.size(); ++q) snapped[q].id = static_cast<std::uint32_t>(q);
    DrivenModel machine(config, state);
    SteadyBeats beats(snapped);
    return drive(machine, beats, [&](std::uint64_t cycle, const ClockedOutputs& out, bool) {
      if (cycle % 65536 == 0) settings.stop.check();
      return !beats.done() || out.busy;
    });
  }

  CyclesKey cycles_of(const Config& config) const { return cycles_key(config, input.state); }

  PointResult result(const DrawTotals& totals, const PositionData& at, const PortQuads& port) const {
    PointResult out;
    out.fragments = totals.fragments;
    for (std::size_t q = 0; q < outputs.size(); ++q) {
      out.snapping[q] = summary(port.snapping()[q]);
      out.arithmetic[q] = summary(totals.arithmetic[q]);
    }
    out.coverage_gained = totals.fragments - totals.drawn_as_given;
    out.coverage_lost = given->pixels() - totals.drawn_as_given;
    out.discard_differs = port.drawn() + totals.fragments - 2 * totals.drawn_as_snapped;
    out.colour_codes = totals.colour_codes;
    out.saturated = totals.saturated;
    out.quads = at.covering;
    out.plane_quads = totals.plane_quads;
    out.plane_fragments = totals.plane_fragments;
    out.worst = totals.worst;
    out.attribute_spread = port.spread().attribute;
    out.depth_spread = port.spread().depth.value_or(std::numeric_limits<double>::infinity());
    return out;
  }

  /// The points of `batch`, which is sorted by path, have the same positions.
  Batch run(std::span<const Config> points, std::span<const Path> paths, std::span<const std::size_t> batch,
            const std::function<void(double)>& progress) {
    const tb::Stopwatch start;
    Batch out;
    out.points.assign(batch.begin(), batch.end());
    out.results.resize(batch.size());
    const std::shared_ptr<const PositionData> at = position_data(points[batch.front()], out.executed);
    // Batches are sorted by path.
    std::vector<Group> groups;
    std::vector<std::size_t> drawing(batch.size());  // of each point, its number among those drawn
    std::size_t drawings = 0;
    for (std::size_t n = 0; n < batch.size(); ++n) {
      const Path &path = paths[batch[n]], &before = paths[batch[n == 0 ? 0 : n - 1]];
      if (n != 0 && path == before) {
        drawing[n] = drawings - 1;
        continue;
      }
      drawing[n] = drawings++;
      if (n == 0 || path[1] != before[1] || groups.back().points.size() == points_per_unit)
        groups.push_back({port_quads(points[batch[n]]), {}});
      groups.back().points.push_back(n);
      count(out.executed, Stage::draw, at->fragments);
    }
    fit_memory();

    // The clocked model's runs first: they are the longest units.
    std::map<CyclesKey, std::size_t> cycle_runs;
    std::vector<std::pair<std::size_t, std::uint64_t>> runs;  // point, clocks
    for (const std::size_t point : batch)
      if (settings.cycles && !cycles.contains(cycles_of(points[point])) &&
          cycle_runs.emplace(cycles_of(points[point]), runs.size()).second)
        runs.emplace_back(point, 0);

    std::vector<std::vector<DrawTotals>> totals(settings.threads);
    const std::vector<DrawPart> parts = draw_parts(*at, input.state);
    const std::size_t units = runs.size() + groups.size() * parts.size();
    run_units(
        units, settings.threads,
        [&](std::size_t unit, unsigned thread) {
          settings.stop.check();
          if (unit < runs.size()) {
            runs[unit].second = clocks(points[runs[unit].first]);
            return;
          }
          unit -= runs.size();
          const Group& group = groups[unit / parts.size()];
          totals[thread].resize(drawings);
          std::vector<PointDraw> draws;
          for (const std::size_t n : group.points) draws.push_back({points[batch[n]], &totals[thread][drawing[n]]});
          draw_points(input, *at, *group.port, draws, parts[unit % parts.size()]);
        },
        [&](std::size_t done) { progress(static_cast<double>(done) / static_cast<double>(units)); });

    for (const auto& [key, run] : cycle_runs) {
      cycles[key] = runs[run].second;
      count(out.executed, Stage::cycles, runs[run].second);
    }
    for (const Group& group : groups)
      for (const std::size_t first : group.points) {
        DrawTotals sum;
        for (const std::vector<DrawTotals>& part : totals)
          if (!part.empty()) sum.merge(part[drawing[first]]);
        for (std::size_t n = first; n < batch.size() && drawing[n] == drawing[first]; ++n) {
          out.results[n] = result(sum, *at, *group.port);
          if (settings.cycles) out.results[n].cycles = cycles.at(cycles_of(points[batch[n]]));
        }
      }
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
  std::array<Names, std::tuple_size_v<Path>> names;
  for (std::size_t point = 0; point < points.size(); ++point) {
    const Config& config = points[point];
    if (std::string why = m.refusal(config); !why.empty()) {
      refused.points.push_back(point);
      refused.results.emplace_back().refused = std::move(why);
      continue;
    }
    sorted.push_back(point);
    paths[point] = {names[0](level_key(config, Level::positions)), names[1](port_key(config)),
                    names[2](draw_key(config))};
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
  const std::size_t limit = std::max<std::size_t>(1, m.settings.batch_points);
  for (std::size_t first = 0, end; first < sorted.size(); first = end) {
    const auto same = [&](std::size_t n, std::size_t parts) {
      return std::equal(paths[sorted[n]].begin(), paths[sorted[n]].begin() + parts, paths[sorted[n - 1]].begin());
    };
    end = first + 1;
    while (end < sorted.size() && (end - first < limit ? same(end, 1) : same(end, 3))) ++end;
    const std::span batch = std::span(sorted).subspan(first, end - first);
    deliver(m.run(points, paths, batch, [&](double part) {
      show(static_cast<double>(finished) + part * static_cast<double>(batch.size()));
    }));
  }
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
  const auto at = m.position_data(point, m.counters);
  const auto port = m.port_quads(point);
  count(m.counters, Stage::draw, at->fragments);
  m.fit_memory();
  std::vector<float> lane_errors(at->blocks() * lane_count, -1.0f);
  std::vector<DrawTotals> totals(m.settings.threads);
  const std::vector<DrawPart> parts = draw_parts(*at, state);
  run_units(parts.size(), m.settings.threads, [&](std::size_t part, unsigned thread) {
    m.settings.stop.check();
    const PointDraw draw{point, &totals[thread]};
    draw_points(m.input, *at, *port, std::span(&draw, 1), parts[part], lane_errors);
  });
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
