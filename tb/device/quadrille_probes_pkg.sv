// What crosses the boundaries between the machine's units: a packed struct for each, first member most significant. The fields are told in
// rtl/SPEC.md, Probes; the C++ twins are the layouts of model/boundaries.hpp; widths are compared when a simulator is loaded.
package quadrille_probes_pkg;
  import quadrille_pkg::*;

  typedef struct packed {
    logic [QUAD_SLOTS_LOG2-1:0] slot;
    logic [TC_BITS-1:0] tile_x0;
    logic [TC_BITS-1:0] tile_y0;
    logic [TC_BITS-1:0] tiles_x;
    logic [TC_BITS-1:0] tiles_y;
    logic homogeneous;
    logic hull;
    logic [3:0] visible;
    logic [6*VAL_BITS-1:0] lin_value;
    logic [6*GRAD_BITS-1:0] lin_gx;
    logic [6*GRAD_BITS-1:0] lin_gy;
    logic [6*LENGTH2_BITS-1:0] length2;
  } probe_setup_t;

  typedef struct packed {
    logic end_token;
    logic [QUAD_SLOTS_LOG2-1:0] slot;
    logic [TC_BITS-1:0] tile_x;
    logic [TC_BITS-1:0] tile_y;
    logic [6*VAL_BITS-1:0] lin_value;
    logic [10*QVAL_BITS-1:0] quad_value;
    logic [10*QGRAD_BITS-1:0] quad_gx;
    logic [10*QGRAD_BITS-1:0] quad_gy;
    logic [10*QCURV_BITS-1:0] quad_q;
  } probe_tile_t;

  typedef struct packed {
    logic end_token;
    logic [RING_LOG2:0] tile_ptr;
    logic [TILE_LOG2-1:0] row;
    logic [TILE-1:0] mask;
    logic [TILE-1:0] front;
    logic [TILE-1:0] tie;
  } probe_stamp_t;

  typedef struct packed {
    logic [QUAD_SLOTS_LOG2-1:0] slot;
    logic [VIEWPORT_BITS-1:0] x;
    logic [VIEWPORT_BITS-1:0] y;
    logic front;
    logic tie;
    logic [6*VAL_BITS-1:0] a;
    logic [6*QVAL_BITS-1:0] d;
    logic [4*QVAL_BITS-1:0] r2;
  } probe_diff_t;

  typedef struct packed {
    logic two_corner;
    logic on_vertex;
    logic two_edge;
    logic on_edge;
    logic [5:0] a_neg;
    logic [6*EXP_BITS-1:0] a_exp;
    logic [6*SIGNIFICAND_BITS-1:0] a_sig;
    logic [5:0] d_neg;
    logic [6*EXP_BITS-1:0] d_exp;
    logic [6*SIGNIFICAND_BITS-1:0] d_sig;
    logic [4*EXP_BITS-1:0] r2_exp;
    logic [4*SIGNIFICAND_BITS-1:0] r2_sig;
  } probe_norm_t;

  typedef struct packed {
    logic [4*EXP_BITS-1:0] exp;
    logic [4*SIGNIFICAND_BITS-1:0] sig;
  } probe_sqrt_t;

  typedef struct packed {
    logic [6*EXP_BITS-1:0] u_exp;
    logic [6*SIGNIFICAND_BITS-1:0] u_sig;
    logic [6*EXP_BITS-1:0] v_exp;
    logic [6*SIGNIFICAND_BITS-1:0] v_sig;
  } probe_ratio_t;

  typedef struct packed {
    logic [4*EXP_BITS-1:0] exp;
    logic [4*SIGNIFICAND_BITS-1:0] sig;
  } probe_weight_t;

  typedef struct packed {
    logic [ATTRIBUTE_SLOTS-1:0] attr_neg;
    logic [ATTRIBUTE_SLOTS*EXP_BITS-1:0] attr_exp;
    logic [ATTRIBUTE_SLOTS*SIGNIFICAND_BITS-1:0] attr_sig;
    logic z_neg;
    logic [EXP_BITS-1:0] z_exp;
    logic [SIGNIFICAND_BITS-1:0] z_sig;
    logic den_k_neg;
    logic [EXP_BITS-1:0] den_k_exp;
    logic [SIGNIFICAND_BITS-1:0] den_k_sig;
    logic den_w_neg;
    logic [EXP_BITS-1:0] den_w_exp;
    logic [SIGNIFICAND_BITS-1:0] den_w_sig;
  } probe_sum_t;
endpackage
