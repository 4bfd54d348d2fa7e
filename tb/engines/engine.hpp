// The engines behind one interface: quads as given in, fragments as numbers out.
#pragma once

#include "model/config.hpp"
#include "model/records.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::cli {

/// All that draws, the last two in `bench --error` alone.
enum class EngineKind { rtl, model, paper_float, shader, truth, paper_single, model_plain, model_clocked };
struct EngineInfo {
  std::string_view name, help;
  bool machine = false;  ///< every bit is that of the machine
};
inline constexpr std::array<EngineInfo, 8> engine_table{{{"rtl", "the RTL under Verilator", true},
                                                         {"model", "the untimed model", true},
                                                         {"float", "the paper's formulas in double precision"},
                                                         {"shader", "the papers' shader in single precision on OpenGL"},
                                                         {"truth", "exact arithmetic"},
                                                         {"fp32", "the paper's formulas in single precision"},
                                                         {"model-plain", "the untimed model with plain integers", true},
                                                         {"model-clocked", "the clocked model alone", true}}};
constexpr const EngineInfo& engine_info(EngineKind kind) { return engine_table[static_cast<std::size_t>(kind)]; }

/// One T for each.
template <class T>
struct PerEngine : std::array<T, engine_table.size()> {
  T& operator[](EngineKind kind) { return this->data()[static_cast<std::size_t>(kind)]; }
  const T& operator[](EngineKind kind) const { return this->data()[static_cast<std::size_t>(kind)]; }
};

/// Names of the choices of --engine: of all that make_engine() makes; fp32 where `single`.
std::vector<std::string> engine_choices(bool single);
/// Throws UsageError with these for any other name.
EngineKind engine_kind(std::string_view name, bool single = false);

/// Bit of a written flags column beyond FragmentFlag: the numbers are not to be used (float, fp32 and shader).
inline constexpr std::uint32_t flag_undefined = 256;

/// One fragment in numbers.
struct EngineSample {
  std::uint32_t index = 0;  ///< position of the quad in the draw
  std::uint32_t quad = 0;   ///< its id
  std::uint16_t x = 0, y = 0;
  bool front = false;
  bool undefined = false;  ///< float, fp32, shader: the formulas divide by zero here; numbers are not to be used
  std::uint8_t flags = 0;  ///< FragmentFlag
  double z = 0;
  std::array<double, 4> lambda{};
  std::array<double, max_attribute_slots> attribute{};
};

/// Gets fragments in the order of the quads; within a quad in the engine's own order. The span lives for the call only.
using SampleSink = std::function<void(std::span<const EngineSample>)>;

struct EngineSettings {
  EngineKind kind = EngineKind::model;
  Config config;
  DrawState state;   ///< state.attributes is set by draw()
  bool snap = true;  ///< float, fp32, shader, truth: on the snapped quads; rtl and model always are
  unsigned threads = 1;
  double stall = 0, gap = 0;  ///< rtl
  std::uint64_t seed = 1;     ///< rtl
};

class Engine {
 public:
  virtual ~Engine() = default;
  /// Draws the quads with their first `attributes` attributes (at most max_attribute_slots) and, if `weights`, the mean
  /// value weights. The machine measures weights at its attribute outputs and draws as many times as its slots require.
  /// What `sink` gets does not depend on the number of threads. Throws SnapError for a quad that cannot be drawn.
  virtual void draw(std::span<const WindowQuad> quads, int attributes, bool weights, const SampleSink& sink) = 0;
};

/// Throws StudyNeeded for the engine `shader` unless set_shader_engine() was called.
std::unique_ptr<Engine> make_engine(const EngineSettings& settings);
/// What makes the engine `shader`. The program of the studies sets it at its start.
using EngineMaker = std::unique_ptr<Engine> (*)(const EngineSettings&);
void set_shader_engine(EngineMaker maker);

/// One draw of the machine: which columns its attribute slots carry. Columns 0-3 are the weights, column 4 + j
/// attribute j.
struct Pass {
  std::vector<int> columns;
};

/// As few passes as `slots` attributes in use allow; without any column one pass with none.
std::vector<Pass> plan_passes(int attributes, bool weights, int slots);
/// The same with all of the configuration's slots.
std::vector<Pass> plan_passes(int attributes, bool weights, const Config& config);

/// The weights, then the attributes in passes of their own: what a judge compares with the truth. The first
/// `weight_passes` of them carry weights.
std::vector<Pass> plan_judged_passes(int attributes, int slots, std::size_t* weight_passes = nullptr);

/// The quad with the pass's columns as attributes.
WindowQuad pass_quad(const WindowQuad& quad, const Pass& pass);

/// Snaps a quad under another id, its position in the draw say: ids of an input may repeat. Errors name the quad's own
/// id.
SnappedQuad snap_as(const WindowQuad& quad, std::uint32_t id, const Config& config, const DrawState& state);

/// Throws UsageError when `quads` positions do not fit the machine's quad ids.
void check_quad_count(std::size_t quads, const Config& config);

/// The draw state of a pass, `first` or another. Of plane quads the last bits of depth depend on whether a pass's
/// columns are plane too (skip_plane). Then the first pass alone decides by depth which fragments there are: the others
/// give these fragments and, where the first has discarded or hidden some, more.
DrawState state_of_pass(DrawState state, const Pass& pass, bool first);

/// A machine's fragment as numbers; adds the columns of one pass to `sample`, and depth if it is the first.
void read_columns(const Fragment& fragment, const Pass& pass, const Config& config, EngineSample& sample,
                  bool first = true);

/// The configuration that snaps `attributes` attributes whatever the machine's slots are; vertices and weights are the
/// same.
Config snapping_config(Config config, int attributes);

}  // namespace quadrille::cli
