// Every boundary of the machine, described once: its fields in the order of the packed struct (rtl/README.md, Ports;
// rtl/SPEC.md, Probes), most significant first, with width, sign, fraction bits, unit and meaning. From these lists
// come what the co-simulation compares and names, its probes (tb/device/probes), the records of the golden vectors (hex
// and manifest) and with them the DPI structs and the ports of the replay benches, and the table of rtl/README.md.
// fields.hpp says what a list is.
#pragma once

#include "model/port/config.hpp"
#include "model/port/fields.hpp"
#include "model/port/records.hpp"
#include "model/port/stages.hpp"

#include <concepts>
#include <string>
#include <type_traits>
#include <vector>

namespace quadrille {

// ---- Widths by name ----

inline Bits slot_bits(const Config& c) { return {c.quad_slots_log2, "QUAD_SLOTS_LOG2"}; }
inline Bits quad_id_bits(const Config& c) { return {c.quad_id_bits, "QUAD_ID_BITS"}; }
inline Bits viewport_bits(const Config& c) { return {c.viewport_bits, "VIEWPORT_BITS"}; }
inline Bits scissor_bits(const Config& c) { return {c.viewport_bits + 1, "VIEWPORT_BITS+1"}; }
inline Bits tile_bits(const Config& c) { return {c.tile(), "TILE"}; }
inline Bits tile_log2(const Config& c) { return {c.tile_log2, "TILE_LOG2"}; }
inline Bits tc_bits(const Config& c) { return {c.tc_bits(), "TC_BITS"}; }
inline Bits t_bits(const Config& c) { return {c.t_bits(), "T_BITS"}; }
inline Bits w_bits(const Config& c) { return {c.w_bits(), "W_BITS"}; }
inline Bits frac_bits(const Config& c) { return {c.frac(), "FRAC"}; }
inline Bits exact_frac(const Config& c) { return {2 * c.frac(), "2·FRAC"}; }
inline Bits quadratic_frac(const Config& c) { return {c.quadratic_frac(), "QUADRATIC_FRAC_BITS"}; }
inline Bits val_bits(const Config& c) { return {c.val_bits(), "VAL_BITS"}; }
inline Bits grad_bits(const Config& c) { return {c.grad_bits(), "GRAD_BITS"}; }
inline Bits qval_bits(const Config& c) { return {c.qval_bits(), "QVAL_BITS"}; }
inline Bits qgrad_bits(const Config& c) { return {c.qgrad_bits(), "QGRAD_BITS"}; }
inline Bits qcurv_bits(const Config& c) { return {c.qcurv_bits(), "QCURV_BITS"}; }
inline Bits length2_bits(const Config& c) { return {c.length2_bits(), "LENGTH2_BITS"}; }
inline Bits significand_bits(const Config& c) { return {c.significand_bits, "S"}; }
inline Bits significand_frac(const Config& c) { return {c.significand_bits - 1, "S−1"}; }
inline Bits depth_code_bits(const Config& c) { return {c.depth_bits + 1, "DEPTH_BITS+1"}; }
inline Bits corner_depth_bits(const Config& c) { return {c.depth_bits + 2, "DEPTH_BITS+2"}; }
inline Bits depth_frac(const Config& c) { return {c.depth_bits, "DEPTH_BITS"}; }
inline Bits attr_out_bits(const Config& c) { return {c.attr_out_bits(), "ATTR_OUT_BITS"}; }
inline Bits attr_out_frac(const Config& c) { return {c.attribute_frac(), "F"}; }
inline constexpr Bits exp_bits{Config::exp_bits, "EXP_BITS"}, port_exp_bits{Config::port_exp_bits, "PORT_EXP_BITS"};

// ---- Fields that several lists have ----

inline FieldType linear_value(const Config& c) {
  return fixed("lin_value", val_bits(c), exact_frac(c), "px^2",
               "edge functions E01 E12 E23 E30 E20 E13 at the origin pixel");
}
inline FieldType linear_gx(const Config& c) {
  return fixed("lin_gx", grad_bits(c), exact_frac(c), "px^2", "their steps to the next column");
}
inline FieldType linear_gy(const Config& c) {
  return fixed("lin_gy", grad_bits(c), exact_frac(c), "px^2", "their steps to the next row");
}
inline FieldType quadratic_value(const Config& c) {
  return fixed("quad_value", qval_bits(c), quadratic_frac(c), "px^2",
               "dot products D01 D12 D23 D30 D20 D13 and squared distances 0 to 3 at the origin pixel");
}
inline FieldType quadratic_gx(const Config& c) {
  return fixed("quad_gx", qgrad_bits(c), quadratic_frac(c), "px^2",
               "linear coefficients in x: f(dx, dy) = value + dx gx + dy gy + q (dx^2 + dy^2)");
}
inline FieldType quadratic_gy(const Config& c) {
  return fixed("quad_gy", qgrad_bits(c), quadratic_frac(c), "px^2", "linear coefficients in y");
}
inline FieldType quadratic_q(const Config& c) {
  return fixed("quad_q", qcurv_bits(c), quadratic_frac(c), "px^2", "quadratic coefficients");
}
inline FieldType squared_length(const Config& c) {
  return {"length2",         length2_bits(c), false,
          quadratic_frac(c), "px^2",          "squared distances of the vertices of the pairs 01 12 23 30 20 13"};
}
inline FieldType exact_a(const Config& c) {
  return fixed("a", val_bits(c), exact_frac(c), "px^2", "A: edge functions at the pixel, pairs 01 12 23 30 20 13");
}
inline FieldType exact_d(const Config& c) {
  return fixed("d", qval_bits(c), quadratic_frac(c), "px^2", "D: dot products, the same pairs");
}
inline FieldType exact_r2(const Config& c) {
  return fixed("r2", qval_bits(c), quadratic_frac(c), "px^2", "squared distances of the corners");
}
inline FieldType depth_type(const Config& c, const char* name, const char* meaning) {
  return {name, depth_code_bits(c), false, depth_frac(c), "1", meaning};
}
inline FieldType attribute_type(const Config& c) {
  return fixed("attr", attr_out_bits(c), attr_out_frac(c), "1", "attribute");
}
inline FpType magnitudes(const char* exp, const char* sig, const Config& c, const char* meaning) {
  return {nullptr, exp, sig, exp_bits, significand_bits(c), meaning};
}
inline FpType signed_numbers(const char* neg, const char* exp, const char* sig, const Config& c, const char* meaning) {
  return {neg, exp, sig, exp_bits, significand_bits(c), meaning};
}
inline FpType port_numbers(const char* neg, const char* exp, const char* sig, const Config& c, const char* meaning) {
  return {neg, exp, sig, port_exp_bits, significand_bits(c), meaning};
}

// ---- Ports ----

/// vertex_t.
template <class Beat, class F>
requires std::same_as<std::remove_const_t<Beat>, VertexBeat>
void visit(Beat& beat, const Config& c, F&& f) {
  auto& v = beat.vertex;
  f(plain("id", quad_id_bits(c), "quad; the first beat's counts"), -1, beat.id);
  f(fixed("x", t_bits(c), frac_bits(c), "px", "X, relative to pixel centres"), -1, v.x);
  f(fixed("y", t_bits(c), frac_bits(c), "px", "Y, down"), -1, v.y);
  f(fixed("w", w_bits(c), frac_bits(c), "1", "W"), -1, v.w);
  const auto exponent = [](const char* name, const char* meaning) {
    return FieldType{name, port_exp_bits, true, {}, "log2", meaning};
  };
  const auto significand = [&](const char* name, const char* meaning) {
    return FieldType{name, significand_bits(c), false, significand_frac(c), "1", meaning};
  };
  f(exponent("k_exp", "exponent of k"), -1, v.k.exp);
  f(significand("k_sig", "k, the factor of this vertex"), -1, v.k.sig);
  visit_number(f, port_numbers("z_neg", "z_exp", "z_sig", c, "k times (z minus base)"), v.z);
  for (int i = c.attribute_slots; i-- > 0;) {
    auto& a = v.attribute[static_cast<std::size_t>(i)];
    f(plain("attr_neg", 1, "sign of attr_sig's number"), i, a.neg);
    f(exponent("attr_exp", "its exponent"), i, a.exp);
    f(significand("attr_sig", "k times (attribute minus base); of vertex 0 not looked at"), i, a.sig);
  }
  visit_array(
      f, fixed("base_attr", attr_out_bits(c), attr_out_frac(c), "1", "base of an attribute; the first beat's counts"),
      c.attribute_slots, [&](std::size_t i) -> auto& { return beat.base.attribute[i]; });
  f(depth_type(c, "base_depth", "base of window z; the first beat's counts"), -1, beat.base.depth);
  f(fixed("depth_low", corner_depth_bits(c), depth_frac(c), "1", "least corner's z, -2^-DEPTH_BITS: below 0"), -1,
    beat.base.depth_low);
  f(fixed("depth_high", corner_depth_bits(c), depth_frac(c), "1", "greatest corner's z, 1 + 2^-DEPTH_BITS: above 1"),
    -1, beat.base.depth_high);
}

/// state_t. Its depth interval is the codes `znear` and `zfar`.
template <class State, class Code, class F>
void visit_state(State& s, Code& znear, Code& zfar, const Config& c, F&& f) {
  f(plain("scissor_x0", scissor_bits(c), "first column that may be drawn", "px"), -1, s.scissor_x0);
  f(plain("scissor_y0", scissor_bits(c), "first row", "px"), -1, s.scissor_y0);
  f(plain("scissor_x1", scissor_bits(c), "first column behind them", "px"), -1, s.scissor_x1);
  f(plain("scissor_y1", scissor_bits(c), "first row behind them", "px"), -1, s.scissor_y1);
  f(plain("cull", 2, "0 none, 1 front, 2 back"), -1, s.cull);
  f(plain("perspective", 1, "attributes are perspective-correct"), -1, s.perspective);
  f(plain("depth", 1, "window z is computed and clipped"), -1, s.depth);
  f(depth_type(c, "znear", "smallest window z"), -1, znear);
  f(depth_type(c, "zfar", "largest window z"), -1, zfar);
  f(plain("attributes", 4, "attributes in use"), -1, s.attributes);
  f(plain("skip", 8,
          "what may be skipped; bit 0: tiles that cannot be covered, 1: quads that cannot give a fragment, 2: hidden "
          "tiles, 3: of homogeneous quads what misses the scissor, 4: operands that a fragment does not depend on, "
          "5: mean value weights of plane quads"),
    -1, s.skip);
}

/// fragment_t. `Record` is what a boundary carries, const to pack it and not to unpack it.
template <class Record, class F>
requires std::same_as<std::remove_const_t<Record>, Fragment>
void visit(Record& g, const Config& c, F&& f) {
  f(plain("quad", quad_id_bits(c), "id of the quad"), -1, g.quad);
  f(plain("x", viewport_bits(c), "column", "px"), -1, g.x);
  f(plain("y", viewport_bits(c), "row", "px"), -1, g.y);
  f(plain("front", 1, "front face: counter-clockwise on the screen"), -1, g.front);
  f(plain("flags", 8, "0 on edge, 1 on vertex, 2 two corners, 3 two edges, 4 tie, 5 homogeneous, 6 notch, 7 saturated"),
    -1, g.flags);
  f(depth_type(c, "depth", "window z"), -1, g.depth);
  visit_array(
      f, attribute_type(c), c.attribute_slots, [&](std::size_t i) -> auto& { return g.attribute[i]; });
}

// ---- Probes ----

template <class Record, class F>
requires std::same_as<std::remove_const_t<Record>, SetupResult>
void visit(Record& r, const Config& c, F&& f) {
  f(plain("slot", slot_bits(c), "slot of the quad"), -1, r.slot);
  f(plain("tile_x0", tc_bits(c), "first tile column", "tiles"), -1, r.tile_x0);
  f(plain("tile_y0", tc_bits(c), "first tile row", "tiles"), -1, r.tile_y0);
  f(plain("tiles_x", tc_bits(c), "tile columns, 0 for an empty bounding box", "tiles"), -1, r.tiles_x);
  f(plain("tiles_y", tc_bits(c), "tile rows", "tiles"), -1, r.tiles_y);
  f(plain("homogeneous", 1, "some w is not 1"), -1, r.homogeneous);
  f(plain("hull", 1, "the eye is in the hull of the vertices: visibility by pixel"), -1, r.hull);
  f(plain("visible", 4, "clauses that may be drawn; bit 0: first +, 1: second +, 2: first -, 3: second -"), -1,
    r.visible);
  visit_array(
      f, linear_value(c), linear_count, [&](std::size_t i) -> auto& { return r.linear[i].value; });
  visit_array(
      f, linear_gx(c), linear_count, [&](std::size_t i) -> auto& { return r.linear[i].gx; });
  visit_array(
      f, linear_gy(c), linear_count, [&](std::size_t i) -> auto& { return r.linear[i].gy; });
  visit_array(
      f, squared_length(c), linear_count, [&](std::size_t i) -> auto& { return r.length2[i]; });
}

template <class Record, class F>
requires std::same_as<std::remove_const_t<Record>, TileEntry>
void visit(Record& t, const Config& c, F&& f) {
  f(plain("end_token", 1, "the quad has no further tile; all else but slot is 0"), -1, t.end);
  f(plain("slot", slot_bits(c), "slot of the quad"), -1, t.slot);
  f(plain("tile_x", tc_bits(c), "column of the tile", "tiles"), -1, t.tile_x);
  f(plain("tile_y", tc_bits(c), "row of the tile", "tiles"), -1, t.tile_y);
  visit_array(
      f, linear_value(c), linear_count, [&](std::size_t i) -> auto& { return t.linear[i]; });
  visit_array(
      f, quadratic_value(c), quadratic_count, [&](std::size_t i) -> auto& { return t.quadratic[i].value; });
  visit_array(
      f, quadratic_gx(c), quadratic_count, [&](std::size_t i) -> auto& { return t.quadratic[i].gx; });
  visit_array(
      f, quadratic_gy(c), quadratic_count, [&](std::size_t i) -> auto& { return t.quadratic[i].gy; });
  visit_array(
      f, quadratic_q(c), quadratic_count, [&](std::size_t i) -> auto& { return t.quadratic[i].q; });
}

template <class Record, class F>
requires std::same_as<std::remove_const_t<Record>, StampEntry>
void visit(Record& s, const Config& c, F&& f) {
  f(plain("end_token", 1, "the quad has no further stamp; the masks are 0"), -1, s.end);
  f(plain("tile_ptr", {c.ring_log2() + 1, "TILE_SLOTS_LOG2+2"}, "entry of the tile ring"), -1, s.tile_ptr);
  f(plain("row", tile_log2(c), "row in the tile", "px"), -1, s.row);
  f(plain("mask", tile_bits(c), "covered pixels, bit dx"), -1, s.mask);
  f(plain("front", tile_bits(c), "of these, front faces"), -1, s.front);
  f(plain("tie", tile_bits(c), "of these, decided by the tie rule"), -1, s.tie);
}

/// A, D and squared distances of a pixel.
template <class Record, class F>
void visit_exact(Record& p, const Config& c, F&& f) {
  visit_array(
      f, exact_a(c), 6, [&](std::size_t i) -> auto& { return p.a[i]; });
  visit_array(
      f, exact_d(c), 6, [&](std::size_t i) -> auto& { return p.d[i]; });
  visit_array(
      f, exact_r2(c), 4, [&](std::size_t i) -> auto& { return p.r2[i]; });
}

/// The fields of one pixel at boundary `b` (diff to sum).
template <class Record, class F>
requires std::same_as<std::remove_const_t<Record>, PixelTrace>
void visit(Record& p, Boundary b, const Config& c, F&& f) {
  switch (b) {
    case Boundary::diff:
      f(plain("slot", slot_bits(c), "slot of the quad").at("u_quadrille.u_pixel.u_pipeline.diff_tag.slot"), -1, p.slot);
      f(plain("x", viewport_bits(c), "column", "px")
            .at("{u_quadrille.u_pixel.u_pipeline.diff_tag.tile_x, `QUADRILLE_LANE.diff_tag[2+:TILE_LOG2]}"),
        -1, p.x);
      f(plain("y", viewport_bits(c), "row", "px").at("u_quadrille.u_pixel.u_pipeline.diff_tag.y"), -1, p.y);
      f(plain("front", 1, "front face").at("tag[1]"), -1, p.front);
      f(plain("tie", 1, "coverage was decided by the tie rule").at("tag[0]"), -1, p.tie);
      visit_exact(p, c, f);
      break;
    case Boundary::norm:
      f(plain("two_corner", 1, "two or more r2 are at most 0").at("class[CLASS_BITS-1]"), -1, p.two_corner);
      f(plain("on_vertex", 1, "one r2 is").at("class[CLASS_BITS-2]"), -1, p.on_vertex);
      f(plain("two_edge", 1, "no r2 is, and two or more edges have A = 0 and D < 0").at("class[CLASS_BITS-3]"), -1,
        p.two_edge);
      f(plain("on_edge", 1, "one edge has").at("class[CLASS_BITS-4]"), -1, p.on_edge);
      visit_numbers(
          f,
          signed_numbers("a_neg", "a_exp", "a_sig", c, "A in units of 2^-QUADRATIC_FRAC px^2")
              .while_active("norm_active"),
          6, [&](std::size_t i) -> auto& { return p.a_fp[i]; });
      visit_numbers(
          f, signed_numbers("d_neg", "d_exp", "d_sig", c, "D in the same units").while_active("distance_active"),
          6, [&](std::size_t i) -> auto& { return p.d_fp[i]; });
      visit_numbers(
          f, magnitudes("r2_exp", "r2_sig", c, "r2 in the same units").while_active("distance_active"),
          4, [&](std::size_t i) -> auto& { return p.r2_fp[i]; });
      break;
    case Boundary::sqrt:
      visit_numbers(
          f, magnitudes("exp", "sig", c, "r = r2^(1/2); of 0: 0").while_active("root_active"),
          4, [&](std::size_t i) -> auto& { return p.root[i]; });
      break;
    case Boundary::ratio:
      visit_numbers(
          f, magnitudes("u_exp", "u_sig", c, "u = r r' + |D|, pairs 01 12 23 30 20 13").while_active("ratio_active"),
          6, [&](std::size_t i) -> auto& { return p.u[i]; });
      visit_numbers(
          f,
          magnitudes("v_exp", "v_sig", c, "v = |A|: |tan of half the angle| = v/u, of D < 0 u/v")
              .while_active("ratio_v_active"),
          6, [&](std::size_t i) -> auto& { return p.v[i]; });
      break;
    case Boundary::weight:
      visit_numbers(
          f, magnitudes("exp", "sig", c, "M: weights of the corners up to a common factor"),
          4, [&](std::size_t i) -> auto& { return p.m[i]; });
      break;
    case Boundary::sum:
      visit_numbers(
          f,
          signed_numbers("attr_neg", "attr_exp", "attr_sig", c, "sum of M b of an attribute, corners 1 to 3")
              .from_element(3),
          c.attribute_slots, [&](std::size_t i) -> auto& { return p.num_a[i]; });
      visit_number(f, signed_numbers("z_neg", "z_exp", "z_sig", c, "sum of M Z").from_element(2), p.num_z);
      visit_number(f, signed_numbers("den_k_neg", "den_k_exp", "den_k_sig", c, "sum of M k").from_element(0), p.den_k);
      visit_number(f, signed_numbers("den_w_neg", "den_w_exp", "den_w_sig", c, "sum of M W").from_element(1), p.den_w);
      break;
    default:
      break;
  }
}

// ---- Layouts ----

const char* boundary_name(Boundary b);
/// Each lane of the port has one of its own: the pixels' and the fragments'.
constexpr bool has_lanes(Boundary b) { return b >= Boundary::diff; }
RecordLayout boundary_layout(Boundary b, const Config& config);
RecordLayout vertex_layout(const Config& config);
RecordLayout state_layout(const Config& config);

/// A field, or an array of them, for people.
struct BoundaryField {
  FieldType type;
  int count = 0;  ///< elements of an array; 0: a field that is none
};
struct BoundaryDescription {
  std::string name;
  int bits = 0;
  std::vector<BoundaryField> fields;  ///< the most significant first, elements of interleaved arrays together
};
/// Attribute slots that no other array has as its length, for tables in which that is N.
inline constexpr int slots_of_tables = 5;
/// The structs of rtl/README.md, Ports, and rtl/SPEC.md, Probes.
std::vector<BoundaryDescription> describe_ports(const Config& config);
std::vector<BoundaryDescription> describe_probes(const Config& config);

}  // namespace quadrille
