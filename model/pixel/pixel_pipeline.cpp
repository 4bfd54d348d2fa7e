#include "model/pixel/pixel_pipeline.hpp"

#include "model/skips/plane_quad.hpp"

namespace quadrille {
namespace {

PipelineFloat from_port(const PortNumber& n) { return {n.neg, n.exp, n.sig}; }

}  // namespace

PipelineContext::PipelineContext(const Config& c, const DrawState& s)
    : config(c),
      state(s),
      format{c.significand_bits, c.align_guard_bits},
      sqrt_table(make_sqrt_table(c)),
      recip_table(make_recip_table(c)),
      znear(depth_code(s.znear, c)),
      zfar(depth_code(s.zfar, c)),
      quadratic_bias(-c.qdrop()),
      attribute_frac(c.attribute_frac()) {}

QuadData quad_data(const SnappedQuad& quad, const SetupResult& setup, const Config& config, const DrawState& state) {
  const SignificandFormat f{config.significand_bits, config.align_guard_bits};
  QuadData d;
  d.id = quad.id;
  d.base = quad.base;
  d.homogeneous = setup.homogeneous;
  d.hull = setup.hull;
  d.plane = plane_quad(quad, config, state);
  const bool skips = (state.skip & skip_operands) != 0;
  const auto attributes = skips ? static_cast<std::size_t>(state.attributes) : max_attribute_slots;
  for (std::size_t i = 0; i < 4; ++i) {
    const SnappedVertex& v = quad.vertex[i];
    d.w[i] = fp_from_signed(v.w, -config.frac(), f);
    d.k[i] = state.perspective ? from_port(v.k) : d.w[i];
    d.z[i] = from_port(v.z);
    if (i == 0) continue;  // the base is its value
    for (std::size_t j = 0; j < attributes; ++j) d.b[i][j] = from_port(v.attribute[j]);
  }
  if (skips) {
    d.sum_k = state.attributes > 0;
    if (!state.depth && !setup.hull) d.w = {};
    if (!state.depth) d.z = {};
  }
  return d;
}

void pixel_lane(PixelTrace& p, const TileRow& row, const QuadConstants& constants, const QuadData& quad, int dx,
                const PipelineContext& c) {
  p.valid = true;
  p.slot = row.tile.slot;
  p.quad = quad.id;
  p.x = (row.tile.tile_x << c.config.tile_log2) + dx;
  p.y = (row.tile.tile_y << c.config.tile_log2) + row.row;
  p.homogeneous = quad.homogeneous;
  p.hull = quad.hull;
  p.plane = quad.plane;
  forward_difference_column(p, row, constants, dx);
  normalise(p, c);
  if ((c.state.skip & skip_operands) != 0 && (p.two_corner || p.on_vertex)) {
    p.a_fp = p.d_fp = p.u = p.v = {};
    p.r2_fp = p.root = {};
  } else if (quad.plane) {
    p.d_fp = p.u = {};
    p.r2_fp = p.root = {};
    p.v = p.a_fp;
    for (PipelineFloat& v : p.v) v.neg = false;
  } else {
    sqrt_stage(p, c);
    mean_value_ratios(p, c);
  }
  mean_value_weights(p, quad, c);
  interpolate(p, quad, c);
  if (!quad.sum_k) p.den_k = {};
  fragment_output(p, quad, c);
}

}  // namespace quadrille
