#include "tb/engines/engine.hpp"

#include "tb/engines/machine_engine.hpp"
#include "tb/engines/reference_engine.hpp"
#include "tb/support/choices.hpp"
#include "tb/support/errors.hpp"

#include <cmath>
#include <stdexcept>

namespace quadrille::tb {
namespace {

constinit EngineMaker shader_maker = nullptr;

}  // namespace

std::vector<std::string> engine_choices(bool single) {
  std::vector<std::string> names;
  for (const EngineInfo& engine : std::span(engine_table).first(single ? 6 : 5)) names.emplace_back(engine.name);
  return names;
}

EngineKind engine_kind(std::string_view name, bool single) {
  return static_cast<EngineKind>(choose("engine", name, engine_choices(single)));
}

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
    case EngineKind::model_plain:
    case EngineKind::model_clocked:
      break;
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

}  // namespace quadrille::tb
