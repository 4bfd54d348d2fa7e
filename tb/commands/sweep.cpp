// quadrille sweep: error against hardware cost over a grid of configurations.
#include "tb/commands/commands.hpp"
#include "tb/commands/counters_report.hpp"

#include "golden/io/atomic_file.hpp"
#include "golden/io/config_file.hpp"
#include "golden/io/error.hpp"
#include "golden/io/interrupt.hpp"
#include "golden/io/json_report.hpp"
#include "golden/io/npy.hpp"
#include "model/port/draw_state.hpp"
#include "model/support/parallel.hpp"
#include "tb/commands/sweep_cosim.hpp"
#include "tb/commands/sweep_parts.hpp"
#include "tb/commands/sweep_summary.hpp"
#include "tb/commands/sweep_target.hpp"
#include "tb/engines/engine.hpp"
#include "tb/options/command_line.hpp"
#include "tb/options/input.hpp"
#include "tb/options/shard.hpp"
#include "tb/options/written_file.hpp"
#include "tb/support/csv.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"
#include "tb/support/progress.hpp"
#include "tb/support/source_paths.hpp"
#include "tb/support/stopwatch.hpp"
#include "tb/sweep/evaluator.hpp"
#include "tb/sweep/grid.hpp"
#include "tb/sweep/pareto.hpp"
#include "tb/sweep/point_table.hpp"
#include "tb/sweep/selection.hpp"
#include "tb/sweep/store.hpp"
#include "tb/sweep/synthesis.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>

namespace quadrille::tb {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t point_limit = 1'000'000;  ///< more need --force
constexpr std::size_t knee_count = 3;
constexpr const char* standard_scene = "sphere";
constexpr const char* plane_scene = "sprites_turned";  ///< of an axis of plane_quads
constexpr std::string_view plane_key = "plane_quads";

struct SweepOptions {
  CommonOptions common;
  StateOptions state;
  InputOptions input;
  ShardOptions shards;
  std::vector<std::string> axes, targets;
  std::string out, objective, synth = "none", synth_target = "ecp5", cosim, shade;
  std::uint64_t cosim_fragments = 200'000;
  bool one_at_a_time = false, force = false, fresh = false, exhaustive = false, no_confirm = false, no_cycles = false;
};

/// FNV-1a of the quads as they are drawn: a changed input file is another sweep.
std::string digest(std::span<const WindowQuad> quads) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&](std::uint64_t value) { hash = (hash ^ value) * 0x100000001b3u; };
  const auto add_double = [&](double value) { add(std::bit_cast<std::uint64_t>(value)); };
  for (const WindowQuad& quad : quads) {
    add(quad.id);
    for (const WindowVertex& v : quad.vertex)
      for (const double value : {v.x, v.y, v.z, v.w}) add_double(value);
    for (const std::vector<double>& attributes : quad.attribute)
      for (const double value : attributes) add_double(value);
  }
  char text[20];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

class SweepRun {
 public:
  SweepRun(const SweepOptions& options, std::span<const std::string> arguments)
      : options_(options),
        arguments_(without_outputs(arguments)),
        base_(options.common.config()),
        grid_(make_grid()),
        shard_(Shard::parse(options.shards.shard)) {}

  int run() {
    const Stopwatch start;
    prepare();
    golden::set_interrupt_hint("finished points are kept in " + options_.out + "; the same command resumes");
    sweep::Store store(options_.out, identity(),
                       options_.fresh ? sweep::Store::Existing::discard : sweep::Store::Existing::resume);
    if (std::FILE* text = options_.common.text(); text && !store.results().empty())
      std::fprintf(text, "resumed: %s has %zu points\n", options_.out.c_str(), store.results().size());

    for (const std::string& part : options_.shards.merge) store.merge(part);
    if (!options_.shards.merge.empty()) require_whole(store);

    sweep::Evaluator::Settings settings;
    settings.threads = options_.common.thread_count();
    settings.cycles = !options_.no_cycles;
    sweep::Evaluator evaluator(input_, settings);
    if (targets_.empty())
      evaluate_grid(evaluator, store);
    else
      search(evaluator, store);
    const double evaluation_seconds = start.seconds();
    if (shard_.is_part()) {
      golden::write_file(store.file("stages.csv"), stage_table(store), golden::AtomicFile::Dash::refused);
      if (std::FILE* text = options_.common.text())
        std::fprintf(text, "shard %s: %zu of %zu points in %.1f s; --merge joins shards\n",
                     options_.shards.shard.c_str(), store.results().size(), grid_.size(), evaluation_seconds);
      return exit_ok;
    }

    make_rows(store);
    find_front();
    write_points(store);  // now: what follows may take long
    simulate_and_synthesise(store);
    write(evaluator, store);
    if (std::FILE* text = options_.common.text()) print(text, evaluation_seconds, start.seconds());
    return status();
  }

 private:
  // ---- what is asked for ----

  sweep::Grid make_grid() const {
    std::vector<sweep::Axis> axes;
    for (const std::string& text : options_.axes) axes.push_back(sweep::parse_axis(text));
    const bool search = !options_.targets.empty();
    const bool standard = axes.empty();
    if (standard) axes = search ? sweep::thousand_point_axes() : sweep::default_axes();
    const bool single = options_.one_at_a_time || (standard && !search);
    return sweep::Grid(base_, std::move(axes), single ? sweep::Grid::Kind::one_at_a_time : sweep::Grid::Kind::full);
  }

  void prepare() {
    if (options_.out.empty()) throw UsageError("--out DIR is missing");
    std::vector<std::string> read = options_.input.files();
    read.push_back(options_.common.config_file);
    check_outputs({options_.input.save_camera, options_.common.json}, read);
    if (grid_.size() > point_limit && !options_.force)
      throw UsageError("the axes span " + std::to_string(grid_.size()) +
                       " points, more than a million; use --force or --one-at-a-time");
    if (shard_.is_part() && !options_.targets.empty())
      throw UsageError("--shard conflicts with --target-error: a search has no parts");
    if (shard_.count > grid_.size())
      throw UsageError("--shard " + options_.shards.shard + ": more shards than points (" +
                       std::to_string(grid_.size()) + ")");
    if (options_.exhaustive && options_.targets.empty()) throw UsageError("--exhaustive needs --target-error");
    synth_target_ = parse_synthesis_target(options_.synth_target);
    weights_ = sweep::weights_of(synth_target_);
    if (!options_.common.config_file.empty()) golden::load_cost_weights(options_.common.config_file, weights_);
    for (const std::string& target : options_.targets) targets_.push_back(parse_target(target));
    objective_ = !options_.objective.empty() ? sweep::parse_error_column(options_.objective)
                 : !targets_.empty()         ? targets_.front().column
                                             : sweep::ErrorColumn{};

    input_.state = draw_state();
    InputOptions source = options_.input;
    if (inputs_given(source) == 0) source.scene = asks_for_planes() ? plane_scene : standard_scene;
    draw_ = load_input(source, options_.shade, input_.state, base_, options_.common.seed);
    print_remark(draw_, options_.common);
    input_.state.perspective = input_.state.perspective && draw_.perspective;
    if (draw_.attributes > max_attribute_slots)
      throw UsageError(draw_.name + " has " + std::to_string(draw_.attributes) + " attributes; at most " +
                       std::to_string(max_attribute_slots) + " are measured");
    input_.quads = draw_.quads;
    input_.attributes = draw_.attributes;
    for (const sweep::ErrorColumn& column : measured_columns()) {
      if (column.output == sweep::Output::depth && !input_.state.depth)
        throw UsageError(column.name() + ": depth is not measured with --no-depth");
      if (column.output == sweep::Output::attribute && input_.attributes == 0)
        throw UsageError(column.name() + ": " + draw_.name + " has no attributes");
    }
    // What cannot be understood is refused before the work, not after.
    const std::vector<std::size_t> all = grid_rows(), none;
    const sweep::Candidates candidates{grid_, all, none, none};
    sweep::select_points(options_.synth, candidates);
    if (!options_.cosim.empty()) sweep::select_points(options_.cosim, candidates);
  }

  /// An axis of plane_quads asks for plane quads, unless --skip says what is wanted.
  DrawState draw_state() const {
    Config config = base_;
    bool varies = false;
    for (const sweep::Axis& axis : grid_.axes())
      if (axis.key == plane_key)
        for (const int value : axis.values)
          if (value != 0) {
            config.set(plane_key, value);
            varies = true;
          }
    DrawState state = options_.state.state(options_.common, config);
    if (varies && options_.state.skip == StateOptions{}.skip) state.skip |= skip_plane;
    state.skip &= ~std::uint32_t{skip_hidden};  // every fragment is measured
    return state;
  }

  /// The user gave an axis of plane_quads.
  bool asks_for_planes() const {
    return !options_.axes.empty() &&
           std::ranges::find(grid_.axes(), plane_key, &sweep::Axis::key) != grid_.axes().end();
  }

  std::vector<sweep::ErrorColumn> measured_columns() const {
    std::vector<sweep::ErrorColumn> columns{objective_};
    for (const ErrorTarget& target : targets_) columns.push_back(target.column);
    return columns;
  }

  std::vector<std::size_t> grid_rows() const {
    std::vector<std::size_t> rows(grid_.size());
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = i;
    return rows;
  }

  /// Everything that the results depend on.
  Json identity() const {
    Json json;
    json["version"] = golden::program_version();
    json["input"] = draw_.option;
    json["quads"] = input_.quads.size();
    json["quads_digest"] = digest(input_.quads);
    json["size"] = options_.common.size;
    json["seed"] = options_.common.seed;
    json["state"] = options_.state.spelled();
    json["config"] = Json::object();
    for (const ConfigKey& key : Config::keys()) json["config"][std::string(key.name)] = base_.get(key.name);
    json["kind"] = kind_name();
    json["axes"] = axes_json();
    json["targets"] = options_.targets;
    json["cycles"] = !options_.no_cycles;
    json["exhaustive"] = options_.exhaustive;
    return json;
  }

  std::string kind_name() const {
    if (!targets_.empty()) return "search";
    return grid_.kind() == sweep::Grid::Kind::full ? "full" : "one_at_a_time";
  }

  Json axes_json() const {
    Json json = Json::array();
    for (const sweep::Axis& axis : grid_.axes()) json.push_back({{"key", axis.key}, {"values", axis.values}});
    return json;
  }

  // ---- evaluation ----

  /// Shards that are missing are not to be made up for unseen.
  void require_whole(const sweep::Store& store) const {
    for (std::size_t row = 0; row < grid_.size(); ++row)
      if (!store.results().contains(row) && grid_.point(row).refused.empty())
        throw UsageError("--merge: row " + std::to_string(row) + " is in no shard; the others are in " + options_.out +
                         ", where the same command without --merge adds the rest");
  }

  void evaluate_grid(sweep::Evaluator& evaluator, sweep::Store& store) {
    std::vector<Config> configs;
    std::vector<std::size_t> rows;
    const auto [first, last] = shard_.range(grid_.size());  // neighbours share stages
    for (std::size_t row = first; row < last; ++row) {
      if (store.results().contains(row)) continue;
      const sweep::GridPoint point = grid_.point(row);
      if (!point.refused.empty()) {
        refused_[row] = point.refused;
        continue;
      }
      configs.push_back(point.config);
      rows.push_back(row);
    }
    Progress progress("sweep of " + std::to_string(grid_.size()) + " points", 1'000'000,
                      options_.common.show_progress());
    evaluator.evaluate(
        configs, [&](const sweep::Batch& batch) { store.append(batch, rows); },
        [&](double part) {
          progress.set(static_cast<std::uint64_t>(part * 1e6),
                       std::to_string(store.results().size()) + " points on disk");
        });
  }

  void search(sweep::Evaluator& evaluator, sweep::Store& store) {
    TargetSearch search;
    for (std::size_t row = 0; row < grid_.size(); ++row) {
      const sweep::GridPoint point = grid_.point(row);
      if (!point.refused.empty()) {
        refused_[row] = point.refused;
        continue;
      }
      search.rows.push_back(row);
      search.configs.push_back(point.config);
      search.costs.push_back(scalar_cost(hardware_cost(point.config), weights_));
      search.ordinary.push_back(ordinary_(point.config));
    }
    if (search.rows.empty()) throw UsageError("no valid point in the grid; the first: " + refused_.begin()->second);
    Progress progress("search in " + std::to_string(grid_.size()) + " points", 0, options_.common.show_progress());
    std::uint64_t steps = 0;
    search.targets = targets_;
    search.state = input_.state;
    search.state_options = options_.state.spelled();
    search.seed = options_.common.seed;
    search.threads = options_.common.thread_count();
    search.confirm = !options_.no_confirm;
    search.exhaustive = options_.exhaustive;
    search.progress = [&](const std::string& what) { progress.set(++steps, what); };
    search.evaluate = [&](std::size_t i) {
      const std::size_t row = search.rows[i];
      if (!store.results().contains(row))
        evaluator.evaluate(std::span(&search.configs[i], 1),
                           [&](const sweep::Batch& batch) { store.append(batch, std::span(&row, 1)); });
      return store.results().at(row);
    };
    target_ = search_target(search);
    find_parts(evaluator, store);
  }

  /// Where the answer stands beside each target.
  void find_parts(sweep::Evaluator& evaluator, const sweep::Store& store) {
    const std::size_t row = answer_row(*target_);
    const auto found = store.results().find(row);
    if (found == store.results().end()) return;  // nothing could be evaluated
    const Config config = grid_.point(row).config;
    const auto evaluate = [&](std::span<const Config> configs) {
      std::vector<sweep::PointResult> results(configs.size());
      evaluator.evaluate(configs, [&](const sweep::Batch& batch) {
        for (std::size_t i = 0; i < batch.points.size(); ++i) results[batch.points[i]] = batch.results[i];
      });
      return results;
    };
    for (const ErrorTarget& target : targets_)
      parts_.push_back(target_parts(target, config, found->second, ordinary_(config), input_.state, evaluate));
  }

  // ---- what follows from the results ----

  std::string worst_command(const Config& config, const sweep::WorstPixel& worst) const {
    return "quadrille fragments --engine model " + draw_.option + spelled(config) + " --size " + options_.common.size +
           " --seed " + std::to_string(options_.common.seed) + options_.state.spelled() + " --quad " +
           std::to_string(worst.index) + " --pixel " + std::to_string(worst.x) + "," + std::to_string(worst.y) +
           " --out -";
  }

  void make_rows(const sweep::Store& store) {
    for (std::size_t row = 0; row < grid_.size(); ++row) {
      sweep::PointRow point;
      point.row = row;
      point.config = grid_.point(row).config;
      if (const auto refused = refused_.find(row); refused != refused_.end()) {
        point.result.refused = refused->second;
      } else if (const auto found = store.results().find(row); found != store.results().end()) {
        point.result = found->second;
      } else {
        continue;  // the search did not need it
      }
      rows_.push_back(std::move(point));
    }
    Progress progress("costs and bounds", rows_.size(), options_.common.show_progress());
    ordered_parallel(
        rows_.size(), options_.common.thread_count(),
        [&](std::size_t i) {
          sweep::PointRow& point = rows_[i];
          if (!point.result.refused.empty()) return 0;
          sweep::complete_row(point, weights_, ordinary_(point.config), input_.state.perspective, synth_target_);
          if (point.result.worst.any) point.worst = worst_command(point.config, point.result.worst);
          return 0;
        },
        [&](std::size_t i, int) { progress.set(i + 1); });
  }

  void find_front() {
    std::vector<sweep::CostError> points;
    for (const sweep::PointRow& row : rows_) points.push_back({row.scalar_cost, objective_.value(row.result)});
    const std::vector<std::size_t> front = sweep::pareto_front(points);
    for (const std::size_t i : front) {
      rows_[i].pareto = true;
      front_.push_back(rows_[i].row);
    }
    if (rows_.size() < grid_.size()) {  // a bend of what happened to be evaluated says nothing of the grid
      const auto evaluated = std::ranges::count_if(rows_, [](const auto& row) { return row.result.refused.empty(); });
      no_knee_ = "the search evaluated " + std::to_string(evaluated) + " of " + std::to_string(grid_.size()) +
                 " points, so the front is of these alone";
      return;
    }
    const sweep::Knees found = sweep::knees(points, front, knee_count);
    for (const std::size_t i : found.points) knees_.push_back(rows_[i].row);
    no_knee_ = found.none;
  }

  SweepSummary findings() const { return {grid_, rows_, front_, knees_, no_knee_, objective_, weights_}; }
  const sweep::PointRow& row_of(std::size_t row) const { return findings().row_of(row); }

  void simulate_and_synthesise(sweep::Store& store) {
    std::vector<std::size_t> good;
    for (const sweep::PointRow& row : rows_)
      if (row.result.refused.empty()) good.push_back(row.row);
    const sweep::Candidates candidates{grid_, good, front_, knees_};
    const unsigned threads = options_.common.thread_count();

    std::vector<CosimPoint> cosim;
    const std::vector<sweep::Selected> chosen = options_.cosim.empty()
                                                    ? sweep::default_selection(candidates)
                                                    : sweep::select_points(options_.cosim, candidates);
    for (const sweep::Selected& s : chosen)
      cosim.push_back({s.row, s.why, row_of(s.row).config, row_of(s.row).result.cycles});
    {
      const Stopwatch start;
      Progress progress("co-simulation of " + std::to_string(cosim.size()) + " points", cosim.size(),
                        options_.common.show_progress());
      cosim_ = cosimulate(cosim, input_.quads, input_.attributes, input_.state, options_.cosim_fragments,
                          options_.common.seed, threads, [&](std::size_t done) { progress.set(done); });
      if (!cosim.empty()) store.add_timing({"cosim", cosim.size(), start.seconds()});
    }

    std::vector<sweep::SynthesisPoint> synthesis;
    for (const sweep::Selected& s : sweep::select_points(options_.synth, candidates))
      synthesis.push_back({s.row, row_of(s.row).config});
    const Stopwatch start;
    Progress progress("synthesis of " + std::to_string(synthesis.size()) + " points", synthesis.size(),
                      options_.common.show_progress());
    synthesis_ = sweep::synthesise(synthesis, synth_target_, weights_, threads,
                                   [&](std::size_t done, std::size_t) { progress.set(done); });
    if (!synthesis.empty()) store.add_timing({"synthesis", synthesis.size(), start.seconds()});
    std::vector<double> estimates, measured;
    for (const sweep::SynthesisRow& row : synthesis_) {
      estimates.push_back(row.cost_luts);
      measured.push_back(sweep::measured_cost(row));
    }
    correlation_ = sweep::rank_correlation(estimates, measured);
  }

  // ---- files ----

  /// What it took: of shards that were put together the sum, so it is no part of the manifest.
  static std::string stage_table(const sweep::Store& store) {
    std::string text = "stage,settings,fragments\n";
    for (std::size_t s = 0; s < sweep::stage_count; ++s)
      text += std::string(sweep::stage_names[s]) + "," + std::to_string(store.counters().settings[s]) + "," +
              std::to_string(store.counters().fragments[s]) + "\n";
    return text;
  }

  Json manifest(std::size_t map_row) const {
    Json json = golden::begin_report(base_, options_.common.seed, arguments_);
    json["input"] = draw_.name;
    json["input_option"] = draw_.option;
    json["size"] = options_.common.size;
    json["kind"] = kind_name();
    json["axes"] = axes_json();
    json["grid_points"] = grid_.size();
    json["points"] = rows_.size();
    json["refused"] = std::ranges::count_if(rows_, [](const sweep::PointRow& r) { return !r.result.refused.empty(); });
    json["objective"] = objective_.name();
    json["front"] = front_;
    json["knees"] = knees_;
    json["no_knee"] = no_knee_.empty() ? Json(nullptr) : Json(no_knee_);
    json["cost"] = cost_words(weights_);
    json["cost_weights"] = {{"state", weights_.state},
                            {"multiplier", weights_.multiplier},
                            {"adder", weights_.adder},
                            {"table", weights_.table},
                            {"dsp", weights_.dsp},
                            {"join", weights_.join},
                            {"block_ram", weights_.block_ram}};
    if (performance_) json["performance_counters"] = counters_json(*performance_);
    json["error_map_row"] = map_row < grid_.size() ? Json(map_row) : Json(nullptr);
    if (target_) {
      json["search"] = to_json(*target_);
      json["search"]["row"] = answer_row(*target_);
      for (const TargetParts& parts : parts_) json["search"]["targets"].push_back(to_json(parts));
    }
    json["synthesis"] = {{"points", synthesis_.size()},
                         {"target", options_.synth_target},
                         {"rank_correlation", std::isnan(correlation_) ? Json(nullptr) : Json(correlation_)}};
    json["cosim"] = {{"points", cosim_.size()}, {"ok", cosim_ok()}};
    for (const sweep::PointColumn& column : sweep::point_columns())
      json["columns"].push_back({{"name", column.name}, {"unit", column.unit}, {"meaning", column.meaning}});
    json["identity"] = identity();
    return json;
  }

  void write_points(const sweep::Store& store) const {
    golden::write_file(store.file("points.csv"), sweep::point_table(rows_), golden::AtomicFile::Dash::refused);
  }

  void write(sweep::Evaluator& evaluator, const sweep::Store& store) {
    constexpr auto refused = golden::AtomicFile::Dash::refused;
    golden::write_file(store.file("synth.csv"), sweep::synthesis_table(synthesis_), refused);
    std::string text = "row,why,fragments,cycles,mismatches,cycle_mismatches,first_difference\n";
    for (const CosimRow& r : cosim_)
      text += std::to_string(r.row) + "," + r.why + "," + std::to_string(r.fragments) + "," + std::to_string(r.cycles) +
              "," + std::to_string(r.mismatches) + "," + std::to_string(r.cycle_mismatches) + "," +
              csv_cell(r.first_difference) + "\n";
    golden::write_file(store.file("cosim.csv"), text, refused);
    text = "what,points,seconds\n";
    for (const sweep::Store::Timing& t : store.timings())
      text += t.what + "," + std::to_string(t.points) + "," + sweep::csv_number(t.seconds) + "\n";
    golden::write_file(store.file("timing.csv"), text, refused);
    golden::write_file(store.file("stages.csv"), stage_table(store), refused);

    if (!options_.no_cycles && evaluator.refusal(base_).empty())
      performance_ =
          count_draw({.config = base_, .state = with_possible_skips(input_.state, base_), .seed = options_.common.seed},
                     input_.quads, input_.attributes);
    const std::vector<float> map = evaluator.error_map(base_);
    golden::save_npy(store.file("error_map.npy"), map, input_.state.width, input_.state.height);
    const Json json = manifest(sweep::base_row(grid_));
    golden::save_json(store.file("manifest.json"), json);
    if (!options_.common.json.empty()) golden::save_json(options_.common.json, json);
  }

  // ---- for people ----

  bool cosim_ok() const {
    return std::ranges::all_of(cosim_, [](const CosimRow& row) { return row.ok(); });
  }

  bool has_fragments() const {
    return std::ranges::any_of(rows_, [](const sweep::PointRow& row) { return row.result.fragments > 0; });
  }

  void print(std::FILE* out, double evaluation_seconds, double seconds) const {
    const auto refused =
        std::ranges::count_if(rows_, [](const sweep::PointRow& r) { return !r.result.refused.empty(); });
    std::fprintf(out,
                 "%s: %zu points%s in %.1f s, %zu refused; %.1f s in all\n(%s; seed %llu; base configuration %s)\n\n",
                 draw_.name.c_str(), rows_.size(),
                 rows_.size() < grid_.size() ? (" of " + std::to_string(grid_.size())).c_str() : "", evaluation_seconds,
                 static_cast<std::size_t>(refused), seconds, options_.common.size.c_str(),
                 static_cast<unsigned long long>(options_.common.seed), summary(base_).c_str());
    print_front(out, findings());
    for (const CosimRow& row : cosim_)
      if (!row.ok())
        std::fprintf(stderr, "quadrille: co-simulation of row %zu (%s) failed: %s\n", row.row,
                     varied(grid_, row_of(row.row).config).c_str(),
                     row.fragments == 0 ? "no fragments" : row.first_difference.c_str());
    if (!cosim_.empty()) {
      std::string found = cosim_ok() ? "no mismatch" : "MISMATCH";
      if (cosim_ok() && !std::ranges::all_of(cosim_, &CosimRow::complete))
        found += " in the first " + std::to_string(options_.cosim_fragments) + " fragments of each";
      std::fprintf(out, "\nco-simulated %zu points (%s): %s\n", cosim_.size(),
                   options_.cosim.empty() ? "default, knees and corners" : options_.cosim.c_str(), found.c_str());
    }
    if (!synthesis_.empty()) {
      std::fprintf(out, "synthesized %zu points for %s; rank correlation of estimated cost and %s ", synthesis_.size(),
                   options_.synth_target.c_str(), options_.synth_target == "cells" ? "area" : "LUTs");
      if (std::isnan(correlation_))
        std::fprintf(out, "needs two different points\n");
      else
        std::fprintf(out, "%.3f\n", correlation_);
    }
    if (asks_for_planes()) print_planes(out, findings(), (input_.state.skip & skip_plane) == 0, plane_scene);
    if (performance_) {
      std::fputc('\n', out);
      print_counters(out, *performance_, "of the base, by the clocked model");
    }
    if (target_) print_target(out, findings(), *target_, parts_, draw_.name, !options_.no_confirm);
    std::error_code far;  // from the working directory where that is possible
    const std::filesystem::path report = scripts_directory() / "sweep_report.py",
                                near = std::filesystem::relative(report, far);
    std::fprintf(out, "\nwrote %s/points.csv, manifest.json; %s %s plots them\n", options_.out.c_str(),
                 (far || near.native().starts_with("..") ? report : near).c_str(), options_.out.c_str());
  }

  int status() const {
    if (!has_fragments()) {
      const auto refused =
          std::ranges::find_if(rows_, [](const sweep::PointRow& r) { return !r.result.refused.empty(); });
      std::fprintf(stderr, "quadrille: no fragments drawn%s\n",
                   refused != rows_.end()
                       ? ("; row " + std::to_string(refused->row) + ": " + refused->result.refused).c_str()
                       : "");
      return exit_usage;
    }
    if (std::ranges::all_of(rows_, [&](const sweep::PointRow& r) { return std::isnan(objective_.value(r.result)); })) {
      std::fprintf(stderr,
                   "quadrille: %s not measured on this input (quads with a vertex behind the eye need perspective)\n",
                   objective_.name().c_str());
      return exit_usage;
    }
    if (!cosim_ok()) return exit_mismatch;
    if (target_ && !target_->winner) {
      std::fprintf(stderr, "quadrille: no point meets the target; closest: row %zu (%s), %.3g times the target\n",
                   target_->closest_row, varied(grid_, row_of(target_->closest_row).config).c_str(), target_->closest);
      return exit_mismatch;
    }
    if (target_ && !options_.no_confirm && !target_->confirmed && std::isnan(target_->confirm_closest)) {
      std::fprintf(stderr,
                   "quadrille: row %zu not confirmed: no stress family measures all targets; --no-confirm skips this\n",
                   *target_->winner);
      return exit_mismatch;
    }
    if (target_ && !options_.no_confirm && !target_->confirmed) {
      std::fprintf(stderr,
                   "quadrille: no point meets the target on the input and all stress families; closest: row %zu (%s), "
                   "%.3g times the target\n",
                   target_->confirm_closest_row, varied(grid_, row_of(target_->confirm_closest_row).config).c_str(),
                   target_->confirm_closest);
      return exit_mismatch;
    }
    return exit_ok;
  }

  const SweepOptions options_;
  const std::vector<std::string> arguments_;
  const Config base_;
  const sweep::Grid grid_;
  const Shard shard_;
  SynthesisTarget synth_target_{};
  CostWeights weights_;
  std::vector<ErrorTarget> targets_;
  sweep::ErrorColumn objective_;
  DrawInput draw_;
  sweep::SweepInput input_;

  std::map<std::size_t, std::string> refused_;  ///< rows that were not evaluated
  std::vector<sweep::PointRow> rows_;           ///< rising
  std::vector<std::size_t> front_, knees_;
  std::string no_knee_;
  std::vector<CosimRow> cosim_;
  std::vector<sweep::SynthesisRow> synthesis_;
  double correlation_ = std::numeric_limits<double>::quiet_NaN();
  std::optional<TargetResult> target_;
  std::vector<TargetParts> parts_;                  ///< of answer_row(), a target each
  std::optional<PerformanceCounters> performance_;  ///< of the base configuration
  sweep::OrdinaryInput ordinary_{input_};
};

}  // namespace

void add_sweep_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("sweep", "Measure errors, hardware cost and clocks of many configurations");
  end_help(*command,
           "Without --axis the usual keys vary, one at a time. Without an input --scene sphere is drawn; with an axis "
           "of plane_quads, --scene sprites_turned. The same command resumes an interrupted sweep.\n\n"
           "SELECTION: all, none, pareto, corners, default, knees, rows (3,7,10-12), or several with commas. A point "
           "takes about 20 s to co-simulate the first time, and minutes to synthesize.",
           "0 done; 1 mismatch in co-simulation, or no point meets the target; 2 usage or input error; 3 missing tool",
           {"sweep --axis significand_bits=10:26:2 --scene fig7_floor --out floor",
            "sweep --target-error colour=0.5/255 --size 1920x1080 --out colour",
            "sweep --axis significand_bits=10:26 --merge part0 part1 --out whole"});
  const auto options = std::make_shared<SweepOptions>();
  options->input.add_to(*command);
  add_attributes_option(*command, options->shade);
  options->common.add_to(*command);
  options->state.add_to(*command);
  command->add_option("--axis", options->axes, "Values of a key: A:B[:STEP], a list or auto; repeatable")
      ->type_name("KEY=VALUES")
      ->allow_extra_args(false);
  command->add_flag("--one-at-a-time", options->one_at_a_time, "Vary one axis at a time");
  command
      ->add_option("--target-error", options->targets,
                   "Find the cheapest point with at most this error; repeatable\n"
                   "  lambda, attribute, depth, colour  largest arithmetic error\n"
                   "  total_lambda_max or another       a column of points.csv\n"
                   "  VALUE                             such as 2^-12, 0.5/255 or 1e-6")
      ->type_name("COLUMN=VALUE")
      ->allow_extra_args(false);
  command->add_flag("--exhaustive", options->exhaustive, "Evaluate the whole grid for --target-error");
  command->add_flag("--no-confirm", options->no_confirm, "Do not check the found point on the stress families");
  command
      ->add_option("--objective", options->objective,
                   "Error of the Pareto front (default: arithmetic, or the first --target-error)\n"
                   "  arithmetic  of the weights\n"
                   "  snapping    of the weights\n"
                   "  total       sum of both\n"
                   "  colour      arithmetic error of a quantity\n"
                   "  COLUMN      of points.csv")
      ->type_name("ERROR");
  command->add_option("--cosim", options->cosim, "Points to co-simulate (default: default, knees, corners; at most 8)")
      ->type_name("SELECTION");
  command->add_option("--cosim-fragments", options->cosim_fragments, "Fragments per co-simulation; 0: all")
      ->check(whole_number())
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--synth", options->synth, "Points to synthesize with Yosys")
      ->type_name("SELECTION")
      ->capture_default_str();
  command
      ->add_option("--synth-target", options->synth_target,
                   "Technology of cost and synthesis\n"
                   "  ecp5        Lattice ECP5: LUTs, flip-flops, DSPs, block RAMs\n"
                   "  ecp5-nodsp  the same, multipliers in logic\n"
                   "  cells       standard cells: area and clock (needs OpenSTA)")
      ->type_name("TARGET")
      ->capture_default_str();
  command->add_flag("--no-cycles", options->no_cycles, "Do not count clocks");
  command->add_flag("--force", options->force, "Allow more than a million points");
  options->shards.add_to(*command, "the grid's points", "their --out, and the same options");
  writes_folder(command->add_option("--out", options->out, "Directory of the results; made if missing"))
      ->group(output_group);
  command->add_flag("--fresh", options->fresh, "Replace the sweep in --out")->group(output_group);
  command->callback([options, &invocation] {
    invocation.run = [options, &invocation] { return SweepRun(*options, invocation.arguments).run(); };
  });
}

}  // namespace quadrille::tb
