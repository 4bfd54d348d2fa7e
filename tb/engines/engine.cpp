#include "tb/engines/engine.hpp"

#include "tb/engines/machine_engine.hpp"
#include "tb/engines/reference_engine.hpp"
#include "tb/support/choices.hpp"
#include "tb/support/errors.hpp"

#include <cmath>
#include <stdexcept>

namespace quadrille::cli {
namespace {

constexpr std::array<std::string_view, 6> names{"rtl", "model", "float", "shader", "truth", "fp32"};

constinit EngineMaker shader_maker = nullptr;

}  // namespace

EngineKind engine_kind(std::string_view name, bool single) {
  const std::vector<std::string> choices(names.begin(), names.end() - (single ? 0 : 1));
  return static_cast<EngineKind>(choose("engine", name, choices));
}

std::string_view engine_name(EngineKind kind) { return names[static_cast<std::size_t>(kind)]; }

std::unique_ptr<Engine> make_engine(const EngineSettings& settings) {
  switch (settings.kind) {
    case EngineKind::rtl:
      return make_rtl_engine(settings);
    case EngineKind::model:
      return make_model_engine(settings);
    case EngineKind::shader:
      if (shader_maker == nullptr) throw StudyNeeded("the engine shader");
      return shader_maker(settings);
    case EngineKind::paper_float:
    case EngineKind::paper_single:
    case EngineKind::truth:
      return make_reference_engine(settings);
  }
  throw std::logic_error("engine kind");
}

void set_shader_engine(EngineMaker maker) { shader_maker = maker; }

void read_columns(const Fragment& fragment, const Pass& pass, const Config& config, EngineSample& sample, bool first) {
  sample.x = fragment.x;
  sample.y = fragment.y;
  sample.front = fragment.front;
  sample.flags |= fragment.flags;
  if (first) sample.z = std::ldexp(static_cast<double>(fragment.depth), -config.depth_bits);
  for (std::size_t slot = 0; slot < pass.columns.size(); ++slot) {
    const double value = std::ldexp(static_cast<double>(fragment.attribute[slot]), -config.attribute_frac());
    const auto column = static_cast<std::size_t>(pass.columns[slot]);
    (column < 4 ? sample.lambda[column] : sample.attribute[column - 4]) = value;
  }
}

}  // namespace quadrille::cli
