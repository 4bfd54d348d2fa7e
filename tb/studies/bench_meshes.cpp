#include "tb/studies/bench_meshes.hpp"

#include "golden/io/json_report.hpp"
#include "model/support/parallel.hpp"
#include "tb/commands/counters_report.hpp"
#include "tb/lockstep/lockstep.hpp"
#include "tb/studies/snapped_input.hpp"
#include "tb/support/errors.hpp"
#include "tb/support/output.hpp"
#include "tb/support/progress.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

namespace quadrille::tb {
namespace {

constexpr std::array<int, 3> rates{1, 2, 4};  ///< pixels_per_clock

/// One mesh at one rate.
struct MeshRun {
  PerformanceCounters counters;
  std::uint64_t clocks = 0;  ///< without those that wipe the places of hidden tiles behind reset

  std::uint64_t quads() const { return counters[PerformanceCounter::quads]; }
  double pixels_per_clock() const { return ratio(counters.pixels(), clocks); }
  double clocks_per_quad() const { return ratio(clocks, quads()); }
  static double ratio(std::uint64_t of, std::uint64_t to) {
    return to == 0 ? 0 : static_cast<double>(of) / static_cast<double>(to);
  }
};

std::vector<std::string> meshes_of(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code failed;
  for (std::filesystem::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
    if (at->path().extension() == ".obj") files.push_back(at->path().string());
  if (failed) throw UsageError("--meshes " + folder + ": " + failed.message());
  if (files.empty()) throw UsageError("--meshes " + folder + ": no *.obj in this folder");
  std::ranges::sort(files);
  return files;
}

std::string name_of(const std::string& file) { return std::filesystem::path(file).stem().string(); }

/// A mesh at a rate, all of its attributes that have a slot.
MeshRun draw_mesh(const std::string& file, int rate, const CommonOptions& common) {
  LockstepOptions lockstep;
  lockstep.config = common.config();
  lockstep.config.set("pixels_per_clock", rate);
  lockstep.config.validate();
  InputOptions options;
  options.mesh = file;
  const SnappedInput snapped(options, common, lockstep.config);
  lockstep.state = snapped.state;
  const AloneRun alone = run_clocked_model_alone(snapped.quads, lockstep);
  return {alone.counters, alone.cycles - alone.counters[PerformanceCounter::bound_wipe]};
}

void print(std::FILE* text, const std::vector<std::string>& files, const std::vector<MeshRun>& runs,
           const CommonOptions& common, const std::vector<std::string>& arguments) {
  std::fprintf(text,
               "%s\n%zu mesh%s by the default camera, %s; configuration %s\n\n"
               "rate: pixels_per_clock. bound by: what most clocks were charged to, and their share of all.\n\n"
               "%-24s %7s %9s %5s %9s %13s %12s  %s\n",
               golden::command_line(arguments).c_str(), files.size(), files.size() == 1 ? "" : "es",
               common.size.c_str(), summary(common.config()).c_str(), "", "quads", "pixels", "rate", "clocks",
               "pixels/clock", "clocks/quad", "bound by");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const MeshRun& run = runs[i];
    const PerformanceCounter bound = most_bound(run.counters);
    const bool first = i % rates.size() == 0;
    std::fprintf(text, "%-24s %7s %9s %5d %9llu %13.3f %12.1f  %s %.0f %%\n",
                 first ? name_of(files[i / rates.size()]).c_str() : "",
                 first ? std::to_string(run.quads()).c_str() : "",
                 first ? std::to_string(run.counters.pixels()).c_str() : "", rates[i % rates.size()],
                 static_cast<unsigned long long>(run.clocks), run.pixels_per_clock(), run.clocks_per_quad(),
                 bound_name(bound).c_str(), 100 * MeshRun::ratio(run.counters[bound], run.clocks));
  }
}

}  // namespace

int run_mesh_bench(const MeshBenchOptions& options, const std::vector<std::string>& arguments) {
  const CommonOptions& common = options.common;
  const std::vector<std::string> files = meshes_of(options.folder);
  std::vector<std::string> read = files;
  read.push_back(common.config_file);
  check_outputs({common.json}, read);
  std::vector<MeshRun> runs;
  Progress progress("bench --meshes", files.size() * rates.size(), common.show_progress());
  ordered_parallel(
      files.size() * rates.size(), common.thread_count(),
      [&](std::size_t i) { return draw_mesh(files[i / rates.size()], rates[i % rates.size()], common); },
      [&](std::size_t i, const MeshRun& run) {
        runs.push_back(run);
        progress.set(i + 1, name_of(files[i / rates.size()]));
      });
  if (std::FILE* text = common.text()) print(text, files, runs, common, arguments);
  if (!common.json.empty()) {
    nlohmann::ordered_json json = golden::begin_report(common.config(), common.seed, arguments);
    json["size"] = common.size;
    json["meshes"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < runs.size(); ++i)
      json["meshes"].push_back({{"mesh", name_of(files[i / rates.size()])},
                                {"pixels_per_clock", rates[i % rates.size()]},
                                {"quads", runs[i].quads()},
                                {"pixels", runs[i].counters.pixels()},
                                {"cycles", runs[i].clocks},
                                {"bound", bound_name(most_bound(runs[i].counters))},
                                {"counters", counters_json(runs[i].counters)}});
    golden::save_json(common.json, json);
  }
  return exit_ok;
}

}  // namespace quadrille::tb
