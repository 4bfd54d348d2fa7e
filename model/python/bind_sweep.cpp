// The sweep: errors, bounds, costs and clocks of many configurations on one input.
#include "model/port/draw_state.hpp"
#include "model/port/snap.hpp"
#include "model/python/binding.hpp"
#include "model/support/parallel.hpp"
#include "tb/sweep/evaluator.hpp"
#include "tb/sweep/grid.hpp"
#include "tb/sweep/pareto.hpp"
#include "tb/sweep/point_table.hpp"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <utility>

namespace quadrille::python {
namespace {

using namespace nb::literals;

/// As `quadrille sweep` has it: an axis of plane_quads asks for plane quads; nothing is hidden.
DrawState state_of(DrawState state, const sweep::Grid& grid) {
  for (const sweep::Axis& axis : grid.axes())
    if (axis.key == "plane_quads" && std::ranges::any_of(axis.values, [](int value) { return value != 0; }))
      state.skip |= skip_plane;
  state.skip &= ~std::uint32_t{skip_hidden};
  return state;
}

sweep::SweepInput input_of(const Quads& quads, const DrawState& state) {
  return {quads.quads, static_cast<int>(quads.attributes.size()), state};
}

/// The result of work(stop), called on a thread of its own, without the interpreter's lock; Ctrl-C asks it to end.
template <class Work>
auto end_on_interrupt(const Work& work) {
  const nb::gil_scoped_release released;
  std::atomic<bool> stop{false};
  auto end = std::async(std::launch::async, work, sweep::Stop{&stop});
  Interruptible interruptible;
  while (end.wait_for(std::chrono::milliseconds(100)) == std::future_status::timeout) try {
      interruptible();
    } catch (...) {
      stop = true;
      end.wait();
      throw;
    }
  return end.get();
}

/// The text of points.csv, without `worst`.
std::string table_of(const Quads& quads, const std::vector<std::string>& axes, const Config& base,
                     const DrawState& state, bool one_at_a_time, bool cycles, const std::string& objective,
                     unsigned threads, sweep::Stop stop) {
  const sweep::ErrorColumn column = sweep::parse_error_column(objective);
  std::vector<sweep::Axis> parsed;
  for (const std::string& axis : axes) parsed.push_back(sweep::parse_axis(axis));
  const sweep::Grid grid(base, parsed.empty() ? sweep::default_axes() : parsed,
                         one_at_a_time ? sweep::Grid::Kind::one_at_a_time : sweep::Grid::Kind::full);
  constexpr std::uint64_t most_points = 1'000'000;
  if (grid.size() > most_points) throw ConfigError(std::to_string(grid.size()) + " points, more than a million");
  const sweep::SweepInput input = input_of(quads, state_of(state, grid));
  sweep::Evaluator evaluator(input, {.threads = threads, .cycles = cycles, .stop = stop});
  sweep::OrdinaryInput ordinary(input);

  std::vector<sweep::PointRow> rows(grid.size());
  std::vector<Config> configs;
  std::vector<std::size_t> row_of;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const sweep::GridPoint point = grid.point(row);
    rows[row].row = row;
    rows[row].config = point.config;
    rows[row].result.refused = point.refused;
    if (!point.refused.empty()) continue;
    configs.push_back(point.config);
    row_of.push_back(row);
  }
  evaluator.evaluate(configs, [&](const sweep::Batch& batch) {
    for (std::size_t i = 0; i < batch.points.size(); ++i) rows[row_of[batch.points[i]]].result = batch.results[i];
  });
  std::vector<sweep::CostError> points;
  for (sweep::PointRow& row : rows) {
    if (row.result.refused.empty()) complete_row(row, ecp5_weights, ordinary(row.config), input.state.perspective);
    points.push_back({row.scalar_cost, column.value(row.result)});
  }
  for (const std::size_t i : sweep::pareto_front(points)) rows[i].pareto = true;
  return sweep::point_table(rows);
}

std::string swept(const Quads& quads, const std::vector<std::string>& axes, const Config& base, const DrawState& state,
                  bool one_at_a_time, bool cycles, const std::string& objective, unsigned threads) {
  return end_on_interrupt([&](sweep::Stop stop) {
    return table_of(quads, axes, base, state, one_at_a_time, cycles, objective, threads, stop);
  });
}

nb::ndarray<nb::numpy, float> error_map(const Quads& quads, const Config& config, const DrawState& state,
                                        unsigned threads) {
  auto* const values = new std::vector<float>;
  const nb::capsule owner(values, [](void* p) noexcept { delete static_cast<std::vector<float>*>(p); });
  *values = end_on_interrupt([&](sweep::Stop stop) {
    const sweep::SweepInput input = input_of(quads, state);
    sweep::Evaluator evaluator(input, {.threads = threads, .cycles = false, .stop = stop});
    if (const std::string reason = evaluator.refusal(config); !reason.empty()) {
      DrawState own = state;
      own.attributes = input.attributes;
      for (const WindowQuad& quad : quads.quads) static_cast<void>(snap_quad(quad, config, own));  // SnapError first
      throw ConfigError(reason);
    }
    return evaluator.error_map(config);
  });
  return {values->data(), {static_cast<std::size_t>(state.height), static_cast<std::size_t>(state.width)}, owner};
}

nb::list columns() {
  nb::list result;
  for (const sweep::PointColumn& column : sweep::point_columns())
    result.append(nb::make_tuple(column.name, column.unit, column.meaning));
  return result;
}

}  // namespace

void bind_sweep(nb::module_& m) {
  m.def("sweep", swept, "quads"_a, "axes"_a, "base"_a, "state"_a, "one_at_a_time"_a, "cycles"_a, "objective"_a,
        "threads"_a);
  m.def("error_map", error_map, "quads"_a, "config"_a, "state"_a, "threads"_a);
  m.def("sweep_columns", columns);
}

}  // namespace quadrille::python
