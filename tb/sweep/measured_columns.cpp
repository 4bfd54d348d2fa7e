#include "tb/sweep/measured_columns.hpp"

namespace quadrille::sweep {
namespace {

WindowQuad test_quad(const WindowQuad& quad) {
  WindowQuad out = quad;
  for (std::size_t i = 0; i < 4; ++i) {
    out.attribute[i].assign(4, 0.0);
    out.attribute[i][i] = 1;
    out.attribute[i].insert(out.attribute[i].end(), corner_colour[i].begin(), corner_colour[i].end());
  }
  return out;
}

}  // namespace

WindowQuad own_quad(const WindowQuad& quad, std::size_t attributes) {
  WindowQuad out = quad;
  for (std::vector<double>& values : out.attribute) values.resize(attributes);
  return out;
}

SnappedQuad own_port(const WindowQuad& quad, std::size_t attributes, const Config& config, const DrawState& state) {
  return snap_quad(own_quad(quad, attributes), widest_port(config), state);
}

Config widest_port(Config config) {
  config.attribute_slots = max_attribute_slots;
  config.quad_id_bits = 32;
  return config;
}

PortQuad::PortQuad(const WindowQuad& quad, std::size_t index, std::size_t attributes, const Config& config,
                   const DrawState& state)
    : own(own_port(quad, attributes, config, state)), test(snap_quad(test_quad(quad), widest_port(config), state)) {
  own.id = test.id = static_cast<std::uint32_t>(index);
}

PortQuad::Slot PortQuad::slot(std::size_t column, const Columns& columns) const {
  if (column < Columns::first_attribute) return {&test, column};
  if (column < columns.first_colour()) return {&own, column - Columns::first_attribute};
  return {&test, column - columns.attributes};
}

PortNumber PortQuad::difference(std::size_t column, std::size_t vertex, const Columns& columns) const {
  const Slot at = slot(column, columns);
  return vertex == 0 ? PortNumber{} : at.pass->vertex[vertex].attribute[at.attribute];
}

std::int64_t PortQuad::base(std::size_t column, const Columns& columns) const {
  const Slot at = slot(column, columns);
  return at.pass->base.attribute[at.attribute];
}

}  // namespace quadrille::sweep
