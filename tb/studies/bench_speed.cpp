#include "tb/studies/bench_speed.hpp"

#include "golden/io/json_report.hpp"
#include "golden/reference/paper_float.hpp"
#include "golden/reference/truth.hpp"
#include "golden/scenes/random_mesh.hpp"
#include "model/port/snap.hpp"
#include "model/support/lane_target.hpp"
#include "model/support/parallel.hpp"
#include "model/untimed.hpp"
#include "tb/commands/counters_report.hpp"
#include "tb/device/verilate.hpp"
#include "tb/judge/check.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/studies/bench_timing.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/progress.hpp"
#include "tb/support/stopwatch.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace quadrille::tb {
namespace {

struct Measure {
  std::uint64_t fragments = 0, cycles = 0;
  double seconds = 0;
};

struct Subject {
  std::string name, what;
  std::function<Measure()> run;
  std::vector<double> fragments_per_second{}, cycles_per_second{};
};

class SpeedBench {
 public:
  explicit SpeedBench(const SpeedOptions& options)
      : options_(options), config_(options.common.config()), threads_(options.common.thread_count()) {
    StateOptions state_options;
    state_ = state_options.state(options.common, config_);
    state_.attributes = std::min(4, config_.attribute_slots);
    golden::RandomMeshOptions mesh;
    mesh.width = state_.width;
    mesh.height = state_.height;
    mesh.columns = std::max(1, state_.width / options.quad_size);
    mesh.rows = std::max(1, state_.height / options.quad_size);
    mesh.jitter = 0.3;
    mesh.triangle_share = 0;
    mesh.vary_w = true;
    quads_ = golden::make_random_mesh(options.common.seed, mesh).quads;
    for (const WindowQuad& quad : quads_) snapped_.push_back(snap_quad(quad, config_, state_));
  }

  int run(const std::vector<std::string>& arguments) {
    std::vector<Subject> subjects{{"model", "untimed model, one core", [this] { return model(1); }},
                                  {"model-threads", "untimed model, " + std::to_string(threads_) + " threads",
                                   [this] { return model(threads_); }},
                                  {"truth", "truth (113-bit), one core",
                                   [this] { return reference<golden::TruthQuad>(options_.fragments / 100); }},
                                  {"float", "the paper's formulas in double, one core",
                                   [this] { return reference<golden::PaperFp64Quad>(options_.fragments / 4); }},
                                  {"clocked", "clocked model alone", [this] {
                                     const AloneRun run = run_clocked_model_alone(snapped_, lockstep());
                                     counters_ = run.counters;
                                     return from(run);
                                   }}};
    if (!options_.no_rtl) {
      subjects.push_back({"rtl", "RTL alone (Verilator, without probes)",
                          [this] { return from(run_rtl_alone(snapped_, lockstep())); }});
      subjects.push_back({"lockstep", "RTL and clocked model in lockstep, every boundary compared", [this] {
                            const LockstepReport r = run_lockstep(snapped_, lockstep());
                            if (!r.agreed())
                              throw std::runtime_error("lockstep: " + r.first_divergence.value_or("differs"));
                            return Measure{r.fragments, r.cycles_rtl, r.wall_seconds};
                          }});
      subjects.push_back({"cosim", "the same with every fragment against the truth", [this] { return cosim(); }});
    }
    std::optional<Simulator> other;
    if (!options_.verilator.empty()) {
      VerilateOptions build;
      build.probes = false;
      build.verilator = options_.verilator;
      other = verilate(config_, build);
      subjects.push_back({"rtl-verilator", "RTL alone, by the other Verilator",
                          [&] { return from(run_rtl_alone(*other, snapped_, lockstep())); }});
    }
    measure(subjects);
    print(subjects, arguments);
    if (!options_.common.json.empty()) golden::save_json(options_.common.json, report(subjects, arguments));
    return exit_ok;
  }

 private:
  /// Interleaved, so that a slow spell of the machine meets all alike.
  void measure(std::vector<Subject>& subjects) {
    Progress progress("bench", static_cast<std::uint64_t>(options_.repeat) * subjects.size(),
                      options_.common.show_progress());
    std::uint64_t done = 0;
    for (Subject& subject : subjects) subject.run();  // warm, and built
    for (int round = 0; round < options_.repeat; ++round) {
      for (Subject& subject : subjects) {
        const Measure m = subject.run();
        subject.fragments_per_second.push_back(static_cast<double>(m.fragments) / m.seconds);
        subject.cycles_per_second.push_back(static_cast<double>(m.cycles) / m.seconds);
        progress.set(++done, subject.name);
      }
    }
  }

  LockstepOptions lockstep() const {
    LockstepOptions options;
    options.config = config_;
    options.state = state_;
    options.seed = options_.common.seed;
    options.threads = threads_;
    options.limit_fragments = std::max<std::uint64_t>(1000, options_.fragments / 20);
    return options;
  }

  static Measure from(const AloneRun& run) { return {run.fragments, run.cycles, run.seconds}; }

  /// Every thread draws the mesh until together they have enough.
  Measure model(unsigned threads) const {
    std::vector<std::uint64_t> drawn(threads, 0);
    const std::uint64_t share = options_.fragments;
    const auto work = [&](std::size_t part) {
      UntimedModel model(config_, state_);
      std::uint64_t count = 0, check = 0;
      while (count < share) {
        model.clear_hidden();
        for (const SnappedQuad& quad : snapped_)
          model.draw_arrays(quad, [&](const FragmentArrays& fragments) {
            count += fragments.size;
            check += fragments.depth[fragments.size - 1];
          });
      }
      drawn[part] = count + (check == 1 ? 1 : 0);  // keeps the depths alive
    };
    const Stopwatch stopwatch;
    parallel_for(threads, threads, work);
    Measure m;
    m.seconds = stopwatch.seconds();
    for (const std::uint64_t count : drawn) m.fragments += count;
    return m;
  }

  /// Coverage and sample of every pixel of the quads' rows, round about `limit` fragments.
  template <class Quad>
  Measure reference(std::uint64_t limit) const {
    Measure m;
    double check = 0;
    const Stopwatch stopwatch;
    while (m.fragments < limit) {
      for (const SnappedQuad& snapped : snapped_) {
        const Quad quad(snapped, config_, state_);
        const golden::PixelRect& bounds = quad.rows().bounds();
        for (int y = bounds.y0; y < bounds.y1; ++y) {
          const golden::PixelSpan row = quad.rows().row(y);
          for (int x = row.x0; x < row.x1; ++x) {
            const golden::ReferenceSample sample = quad.sample(x, y);
            if (!sample.covered) continue;
            ++m.fragments;
            check += sample.z;
          }
        }
        if (m.fragments >= limit) break;
      }
    }
    m.seconds = stopwatch.seconds();
    if (!std::isfinite(check)) m.fragments += 0;  // keeps the samples alive
    return m;
  }

  Measure cosim() const {
    WorkQueue queue(judging_threads(threads_), std::size_t{16} * threads_);
    FragmentChecker::Settings settings;
    settings.config = config_;
    settings.state = state_;
    settings.pass = {{}};
    for (int slot = 0; slot < state_.attributes; ++slot) settings.pass.columns.push_back(slot);
    FragmentChecker checker(settings, quads_, snapped_, queue);
    const LockstepReport report =
        run_lockstep(snapped_, lockstep(), [&](const Fragment& fragment) { checker.fragment(fragment); });
    const Stopwatch stopwatch;
    checker.finish(report.complete);
    queue.drain();
    if (!report.agreed() || !checker.result().ok())
      throw std::runtime_error("RTL and model differ on the mesh; run `quadrille cosim`");
    return {report.fragments, report.cycles_rtl, report.wall_seconds + stopwatch.seconds()};
  }

  void print(const std::vector<Subject>& subjects, const std::vector<std::string>& arguments) const {
    std::FILE* text = options_.common.text();
    if (!text) return;
    const double base = median(subjects.front().fragments_per_second);
    std::fprintf(
        text,
        "%s\n%zu quads of about %d px, perspective, depth, %d attributes; configuration %s; lanes %s; median of "
        "%d interleaved runs\n\n",
        golden::command_line(arguments).c_str(), quads_.size(), options_.quad_size, state_.attributes,
        summary(config_).c_str(), std::string(quadrille::name(lane_target())).c_str(), options_.repeat);
    std::fprintf(text, "%-60s %13s %13s %12s\n", "", "fragments/s", "clocks/s", "of the model");
    for (const Subject& subject : subjects) {
      const double fragments = median(subject.fragments_per_second), cycles = median(subject.cycles_per_second);
      std::fprintf(text, "%-60s %13.0f ", subject.what.c_str(), fragments);
      if (cycles > 0)
        std::fprintf(text, "%13.0f", cycles);
      else
        std::fprintf(text, "%13s", "");
      std::fprintf(text, " %12.4f\n", base > 0 ? fragments / base : 0);
    }
    if (!options_.no_rtl)
      std::fprintf(text, "\nRTL alone over lockstep: %.2f; RTL alone over lockstep with the truth: %.2f\n",
                   median(subjects[5].cycles_per_second) / median(subjects[6].cycles_per_second),
                   median(subjects[5].cycles_per_second) / median(subjects[7].cycles_per_second));
    std::fputc('\n', text);
    print_counters(text, counters_, "of the clocked model");
  }

  nlohmann::ordered_json report(const std::vector<Subject>& subjects, const std::vector<std::string>& arguments) const {
    nlohmann::ordered_json json = golden::begin_report(config_, options_.common.seed, arguments);
    json["quads"] = quads_.size();
    json["quad_size"] = options_.quad_size;
    json["threads"] = threads_;
    json["repeat"] = options_.repeat;
    json["lanes"] = quadrille::name(lane_target());
    const double base = median(subjects.front().fragments_per_second);
    for (const Subject& subject : subjects) {
      nlohmann::ordered_json entry;
      entry["what"] = subject.what;
      entry["fragments_per_second"] = median(subject.fragments_per_second);
      if (median(subject.cycles_per_second) > 0) entry["cycles_per_second"] = median(subject.cycles_per_second);
      entry["of_model"] = base > 0 ? median(subject.fragments_per_second) / base : 0;
      entry["runs"] = subject.fragments_per_second;
      json["speed"][subject.name] = entry;
    }
    json["counters"] = counters_json(counters_);
    return json;
  }

  const SpeedOptions& options_;
  const Config config_;
  const unsigned threads_;
  DrawState state_;
  std::vector<WindowQuad> quads_;
  std::vector<SnappedQuad> snapped_;
  PerformanceCounters counters_;  ///< of one run of the clocked model, the same in each
};

}  // namespace

int run_speed_bench(const SpeedOptions& options, const std::vector<std::string>& arguments) {
  return SpeedBench(options).run(arguments);
}

}  // namespace quadrille::tb
