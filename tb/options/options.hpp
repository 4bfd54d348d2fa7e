// Options that several commands share, and what they become: a configuration, a draw state, an input. (Without CLI11,
// which takes seconds to compile: command_line.hpp is for the files that add options.)
#pragma once

#include "model/port/config.hpp"
#include "model/port/records.hpp"
#include "tb/device/verilate.hpp"
#include "tb/engines/engine.hpp"
#include "tb/support/errors.hpp"

#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace quadrille::tb {

struct DrawInput;

/// Makes an engine of one of the papers' methods, to draw the quads of that input, which must outlive the engine.
using MethodEngineMaker = std::function<std::unique_ptr<Engine>(const DrawInput&, const EngineSettings&)>;

/// What main() hands to the commands and gets back.
struct Invocation {
  std::vector<std::string> arguments;  ///< as typed, for reports
  std::function<int()> run;            ///< set by the command that was chosen; returns the exit status
  /// The maker for --method, from the studies. Throws UsageError for an unknown name, StudyNeeded without the studies.
  std::function<MethodEngineMaker(const std::string& name)> method = [](const std::string& name) -> MethodEngineMaker {
    throw StudyNeeded("--method " + name);
  };
};

/// --config --set --size --seed --threads --json --quiet --verbose
struct CommonOptions {
  std::string config_file;
  std::vector<std::string> settings;
  std::string size = "512x512";
  std::uint64_t seed = 1;
  int threads = 0;
  std::string json;
  bool quiet = false, verbose = false;

  /// `draws` false: a command that draws nothing (no --size, --seed, --threads).
  void add_to(CLI::App& app, bool draws = true);
  void add_seed_and_threads(CLI::App& app);
  /// Config file, then --set, then validated.
  Config config() const;
  /// Width and height, checked against the configuration.
  std::pair<int, int> viewport(const Config& config) const;
  unsigned thread_count() const;
  bool show_progress() const { return !quiet && json != "-"; }
  /// Where a person's text goes: standard output, or standard error when --json - has taken it; nowhere when quiet.
  std::FILE* text() const;
};

/// --cull --no-perspective --no-depth --znear --zfar --scissor --skip
struct StateOptions {
  std::string cull = "none";
  bool no_perspective = false, no_depth = false;
  double znear = 0, zfar = 1;
  std::string scissor;
  std::string skip = "tiles,quads,walk,operands";  ///< those of skip_default

  void add_to(CLI::App& app);
  DrawState state(const CommonOptions& common, const Config& config) const;
  /// Those that give this state, for a viewport of its size.
  static StateOptions of(const DrawState& state);
  /// The options as a command line would give them (empty when all are default).
  std::string spelled() const;
};

/// --scene --mesh --merge-pairs --camera --view --up --save-camera --quads --stress --count --corner --strict, and
/// --light
struct InputOptions {
  std::string scene, mesh, camera, view, up, save_camera, quads, stress, corner;
  std::string light;  ///< of the commands that draw pictures
  std::uint64_t count = 1000;
  bool strict = false, merge_pairs = false;

  /// The files among them.
  std::vector<std::string> files() const { return {mesh, camera, quads}; }

  void add_to(CLI::App& app);
  /// --shade, --texture and --light, for a command that draws pictures.
  void add_picture_options(CLI::App& app, std::string& shade, std::string& texture);
};

/// `value` if it is in [0, 1); throws UsageError naming the option otherwise.
double probability(const char* name, double value);

/// --engine --snap --stall --gap
struct EngineOptions {
  std::string engine = "model", snap = "on";
  double stall = 0, gap = 0;
  bool single = false;  ///< the engine fp32 is one, too

  /// With --method, which replaces an engine. `fp32`: for a command that has this engine, too.
  void add_to(CLI::App& app, std::string& method, bool fp32 = false);
  /// Checked; throws UsageError where the engine and --snap do not go together.
  EngineSettings settings(const CommonOptions& common, const StateOptions& state) const;
};

/// --shade for a command that draws no picture.
void add_attributes_option(CLI::App& app, std::string& shade);

/// The keys that differ from their defaults as a command line gives them, " --set key=value" each.
std::string spelled(const Config& config);

}  // namespace quadrille::tb
