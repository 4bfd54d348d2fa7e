// What crosses each stage boundary of the machine, as plain records, and the order of their bits.
//
// visit(record, config, f) calls f(name, index, width, value) for every field in the order of the packed struct of
// rtl/README.md section 6, most significant member first; inside a flat array element 0 is the least significant, so
// arrays are visited from the last element down. The test bench packs and names bits from this one list.
#pragma once

#include "model/config.hpp"
#include "model/records.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace quadrille {

inline constexpr int linear_count = 6;      ///< E01 E12 E23 E30 E20 E13
inline constexpr int quadratic_count = 10;  ///< D01 D12 D23 D30 D20 D13 R²0 R²1 R²2 R²3

/// The vertices (i, j) of linear function k, E_ij = S_i × S_j, and of quadratic function k < 6, S_i · S_j.
inline constexpr std::array<std::array<std::size_t, 2>, linear_count> vertex_pair{
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {2, 0}, {1, 3}}};

/// Significand number inside the pipeline: value = (-1)^neg sig 2^(exp - (S-1)); zero has all fields 0.
struct Fp {
  bool neg = false;
  std::int32_t exp = 0;
  std::uint32_t sig = 0;

  friend bool operator==(const Fp&, const Fp&) = default;
};

/// value + dx·gx + dy·gy; units 2^-2FRAC.
struct LinearForm {
  std::int64_t value = 0, gx = 0, gy = 0;
};

/// value + dx·gx + dy·gy + q·(dx² + dy²); units 2^-quadratic_frac.
struct QuadraticForm {
  std::int64_t value = 0, gx = 0, gy = 0, q = 0;
};

/// What quad_setup hands to tile_walk.
struct SetupResult {
  std::uint32_t slot = 0;
  int tile_x0 = 0, tile_y0 = 0, tiles_x = 0, tiles_y = 0;
  bool homogeneous = false;
  bool hull = false;         ///< the eye is inside the hull: visibility per pixel
  std::uint8_t visible = 0;  ///< bit 0: clause 1 +, 1: clause 2 +, 2: clause 1 −, 3: clause 2 −
  std::array<LinearForm, linear_count> linear{};
  std::array<QuadraticForm, quadratic_count> quadratic{};
};

/// One entry of the tile ring.
struct TileEntry {
  bool end = false;
  std::uint32_t slot = 0;
  int tile_x = 0, tile_y = 0;
  std::array<std::int64_t, linear_count> linear{};  ///< values at the tile's origin pixel
  std::array<QuadraticForm, quadratic_count> quadratic{};
};

/// One entry of the stamp FIFO.
struct StampEntry {
  bool end = false;
  std::uint32_t tile_ptr = 0;
  int row = 0;
  std::uint32_t mask = 0, front = 0, tie = 0;
};

/// Everything one pixel is on its way through the pipeline.
struct PixelTrace {
  bool valid = false, end = false;
  std::uint32_t slot = 0, quad = 0;
  int x = 0, y = 0;
  bool front = false, tie = false, homogeneous = false, hull = false;
  // stage 1
  std::array<std::int64_t, 6> a{}, d{};
  std::array<std::int64_t, 4> r2{};
  // stage 3
  bool two_corner = false, on_vertex = false, two_edge = false, on_edge = false;
  std::array<Fp, 6> a_fp{}, d_fp{};
  std::array<Fp, 4> r2_fp{};
  // stage 6
  std::array<Fp, 4> rho{};
  // stage 10
  std::array<Fp, 6> n{}, dn{};  ///< t = n / dn, magnitudes
  bool cured = false;
  // stage 17
  std::array<Fp, 4> m{};
  // stage 20
  std::array<Fp, max_attribute_slots> num_a{};
  Fp num_z, den_k, den_w;
  // stage 25
  bool drawn = false;  ///< not discarded
  Fragment fragment;
};

enum class Boundary { setup, tile, stamp, diff, norm, rsqrt, ratio, weight, sum, fragment };

template <class F>
void visit(const SetupResult& r, const Config& c, F&& f) {
  f("slot", -1, c.quad_slots_log2, r.slot);
  f("tile_x0", -1, c.tc_bits(), r.tile_x0);
  f("tile_y0", -1, c.tc_bits(), r.tile_y0);
  f("tiles_x", -1, c.tc_bits(), r.tiles_x);
  f("tiles_y", -1, c.tc_bits(), r.tiles_y);
  f("homogeneous", -1, 1, r.homogeneous);
  f("hull", -1, 1, r.hull);
  f("visible", -1, 4, r.visible);
  for (int i = linear_count; i-- > 0;) f("lin_value", i, c.val_bits(), r.linear[i].value);
  for (int i = linear_count; i-- > 0;) f("lin_gx", i, c.grad_bits(), r.linear[i].gx);
  for (int i = linear_count; i-- > 0;) f("lin_gy", i, c.grad_bits(), r.linear[i].gy);
  for (int i = quadratic_count; i-- > 0;) f("quad_value", i, c.qval_bits(), r.quadratic[i].value);
  for (int i = quadratic_count; i-- > 0;) f("quad_gx", i, c.qgrad_bits(), r.quadratic[i].gx);
  for (int i = quadratic_count; i-- > 0;) f("quad_gy", i, c.qgrad_bits(), r.quadratic[i].gy);
  for (int i = quadratic_count; i-- > 0;) f("quad_q", i, c.qcurv_bits(), r.quadratic[i].q);
}

template <class F>
void visit(const TileEntry& t, const Config& c, F&& f) {
  f("end_token", -1, 1, t.end);
  f("slot", -1, c.quad_slots_log2, t.slot);
  f("tile_x", -1, c.tc_bits(), t.tile_x);
  f("tile_y", -1, c.tc_bits(), t.tile_y);
  for (int i = linear_count; i-- > 0;) f("lin_value", i, c.val_bits(), t.linear[i]);
  for (int i = quadratic_count; i-- > 0;) f("quad_value", i, c.qval_bits(), t.quadratic[i].value);
  for (int i = quadratic_count; i-- > 0;) f("quad_gx", i, c.qgrad_bits(), t.quadratic[i].gx);
  for (int i = quadratic_count; i-- > 0;) f("quad_gy", i, c.qgrad_bits(), t.quadratic[i].gy);
}

template <class F>
void visit(const StampEntry& s, const Config& c, F&& f) {
  f("end_token", -1, 1, s.end);
  f("tile_ptr", -1, c.tile_slots_log2 + 1, s.tile_ptr);
  f("row", -1, c.tile_log2, s.row);
  f("mask", -1, c.tile(), s.mask);
  f("front", -1, c.tile(), s.front);
  f("tie", -1, c.tile(), s.tie);
}

template <class F>
void visit_exp_sig(const char* exp_name, const char* sig_name, const Fp* v, int n, const Config& c, F&& f) {
  for (int i = n; i-- > 0;) f(exp_name, i, Config::exp_bits, v[i].exp);
  for (int i = n; i-- > 0;) f(sig_name, i, c.significand_bits, v[i].sig);
}

/// The fields of one pixel at boundary `b` (diff to sum).
template <class F>
void visit(const PixelTrace& p, Boundary b, const Config& c, F&& f) {
  switch (b) {
    case Boundary::diff:
      f("slot", -1, c.quad_slots_log2, p.slot);
      f("x", -1, c.viewport_bits, p.x);
      f("y", -1, c.viewport_bits, p.y);
      f("front", -1, 1, p.front);
      f("tie", -1, 1, p.tie);
      for (int i = 6; i-- > 0;) f("a", i, c.val_bits(), p.a[i]);
      for (int i = 6; i-- > 0;) f("d", i, c.qval_bits(), p.d[i]);
      for (int i = 4; i-- > 0;) f("r2", i, c.qval_bits(), p.r2[i]);
      break;
    case Boundary::norm:
      f("two_corner", -1, 1, p.two_corner);
      f("on_vertex", -1, 1, p.on_vertex);
      f("two_edge", -1, 1, p.two_edge);
      f("on_edge", -1, 1, p.on_edge);
      for (int i = 6; i-- > 0;) f("a_neg", i, 1, p.a_fp[i].neg);
      visit_exp_sig("a_exp", "a_sig", p.a_fp.data(), 6, c, f);
      for (int i = 6; i-- > 0;) f("d_neg", i, 1, p.d_fp[i].neg);
      visit_exp_sig("d_exp", "d_sig", p.d_fp.data(), 6, c, f);
      visit_exp_sig("r2_exp", "r2_sig", p.r2_fp.data(), 4, c, f);
      break;
    case Boundary::rsqrt:
      visit_exp_sig("exp", "sig", p.rho.data(), 4, c, f);
      break;
    case Boundary::ratio:
      visit_exp_sig("n_exp", "n_sig", p.n.data(), 6, c, f);
      visit_exp_sig("d_exp", "d_sig", p.dn.data(), 6, c, f);
      break;
    case Boundary::weight:
      visit_exp_sig("exp", "sig", p.m.data(), 4, c, f);
      break;
    case Boundary::sum:
      for (int i = c.attribute_slots; i-- > 0;) f("attr_neg", i, 1, p.num_a[i].neg);
      visit_exp_sig("attr_exp", "attr_sig", p.num_a.data(), c.attribute_slots, c, f);
      f("z_neg", -1, 1, p.num_z.neg);
      visit_exp_sig("z_exp", "z_sig", &p.num_z, 1, c, f);
      f("den_k_neg", -1, 1, p.den_k.neg);
      visit_exp_sig("den_k_exp", "den_k_sig", &p.den_k, 1, c, f);
      f("den_w_neg", -1, 1, p.den_w.neg);
      visit_exp_sig("den_w_exp", "den_w_sig", &p.den_w, 1, c, f);
      break;
    default:
      break;
  }
}

template <class F>
void visit(const Fragment& g, const Config& c, F&& f) {
  f("quad", -1, c.quad_id_bits, g.quad);
  f("x", -1, c.viewport_bits, g.x);
  f("y", -1, c.viewport_bits, g.y);
  f("front", -1, 1, g.front);
  f("flags", -1, 8, g.flags);
  f("depth", -1, c.depth_bits + 1, g.depth);
  for (int i = c.attribute_slots; i-- > 0;) f("attr", i, c.attr_out_bits(), g.attribute[i]);
}

inline void visit_port_number(auto&& f, const Config& c, const char* neg, const char* exp, const char* sig, int i,
                              const PortNumber& p) {
  f(neg, i, 1, p.neg);
  f(exp, i, Config::port_exp_bits, p.exp);
  f(sig, i, c.significand_bits, p.sig);
}

/// The vertex beat as the packed vertex_t.
template <class F>
void visit_vertex(std::uint32_t id, const SnappedVertex& v, const Config& c, F&& f) {
  f("id", -1, c.quad_id_bits, id);
  f("x", -1, c.t_bits(), v.x);
  f("y", -1, c.t_bits(), v.y);
  f("w", -1, c.w_bits(), v.w);
  f("k_exp", -1, Config::port_exp_bits, v.k.exp);
  f("k_sig", -1, c.significand_bits, v.k.sig);
  visit_port_number(f, c, "z_neg", "z_exp", "z_sig", -1, v.z);
  for (int i = c.attribute_slots; i-- > 0;)
    visit_port_number(f, c, "attr_neg", "attr_exp", "attr_sig", i, v.attribute[i]);
}

/// The draw state as the packed state_t. znear, zfar: fixed point, depth_bits fraction bits (rounding in
/// draw_state.cpp).
std::uint32_t depth_code(double z, const Config& c);

template <class F>
void visit_state(const DrawState& s, const Config& c, F&& f) {
  f("scissor_x0", -1, c.viewport_bits + 1, s.scissor_x0);
  f("scissor_y0", -1, c.viewport_bits + 1, s.scissor_y0);
  f("scissor_x1", -1, c.viewport_bits + 1, s.scissor_x1);
  f("scissor_y1", -1, c.viewport_bits + 1, s.scissor_y1);
  f("cull", -1, 2, static_cast<int>(s.cull));
  f("perspective", -1, 1, s.perspective);
  f("depth", -1, 1, s.depth);
  f("znear", -1, c.depth_bits + 1, depth_code(s.znear, c));
  f("zfar", -1, c.depth_bits + 1, depth_code(s.zfar, c));
  f("attributes", -1, 4, s.attributes);
  f("skip", -1, 8, s.skip);
}

}  // namespace quadrille
