// The engines behind one interface: quads as given in, fragments as numbers out.
#pragma once

#include "model/port/config.hpp"
#include "model/port/fragment_arrays.hpp"
#include "model/port/records.hpp"
#include "tb/passes/pass.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::tb {

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

/// Fragments of one quad as the machine gives them, over all passes: all of them, or the next.
struct QuadFragments {
  std::uint32_t index = 0;  ///< position of the quad in the draw
  std::uint32_t quad = 0;   ///< its id
  FragmentArrays common;    ///< places, flags, depths of the first pass; no attributes
  std::array<const std::int64_t*, 4 + max_attribute_slots> column{};  ///< as in Pass; nullptr: not drawn
};
using QuadSink = std::function<void(const QuadFragments&)>;

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
  /// The same by the model, without a record of each fragment. Other engines do nothing and return false.
  virtual bool draw_quads(std::span<const WindowQuad> /*quads*/, int /*attributes*/, bool /*weights*/,
                          const QuadSink& /*sink*/) {
    return false;
  }
};

/// Throws StudyNeeded for the engine `shader` unless set_shader_engine() was called.
std::unique_ptr<Engine> make_engine(const EngineSettings& settings);
/// What makes the engine `shader`. The program of the studies sets it at its start.
using EngineMaker = std::unique_ptr<Engine> (*)(const EngineSettings&);
void set_shader_engine(EngineMaker maker);

/// A machine's fragment as numbers; adds the columns of one pass to `sample`, and depth if it is the first.
void read_columns(const Fragment& fragment, const Pass& pass, const Config& config, EngineSample& sample,
                  bool first = true);

}  // namespace quadrille::tb
