// SPDX-License-Identifier: Apache-2.0
`include "quadrille_types.svh"
// Whether a quad's values are plane over it, so that any weights give them that reproduce linear functions: areas of
// triangles in the place of mean value weights (mean_value_weights). Latency 2 from the quad, which waits at
// least that long before start.
//
// Taken: an ordinary quad that is a parallelogram, V0 + V2 = V1 + V3 exactly, over which each value in use (k with
// perspective, Z with depth, differences of attributes times k_eff, 0 in vertex 0) is constant along one pair of
// opposite sides: v0 = v1 and v2 = v3, or v0 = v3 and v1 = v2, in every bit. Comparisons alone: sprites, text, faces of
// boxes seen in parallel. Not found: what is plane at an angle to the sides.
module quadrille_plane_quad #(
    localparam int S = quadrille_pkg::SIGNIFICAND_BITS, PE = quadrille_pkg::PORT_EXP_BITS, T = quadrille_pkg::T_BITS,
    localparam int N = quadrille_pkg::ATTRIBUTE_SLOTS, AP = quadrille_pkg::ATTR_PORT_BITS
) (
    input logic clk_i,
    input logic [quadrille_pkg::STATE_BITS-1:0] state_i,
    input logic [quadrille_pkg::QUAD_BITS-1:0] quad_i,
    output logic plane_o
);
  `QUADRILLE_IN(`QUADRILLE_STATE_T, state)
  `QUADRILLE_IN(`QUADRILLE_QUAD_T, quad)
  if (quadrille_pkg::PLANE_QUADS != 0) begin : gen_plane
    localparam int VALUES = 2 + N, SUM = T + 1;

    // ---- Parallelogram ---------------------------------------------------------------------------------------------
    logic [4*SUM-1:0] x, y;
    logic parallelogram_q;

    for (genvar v = 0; v < 4; v++) begin : gen_position
      assign x[v*SUM+:SUM] = SUM'($signed(quad.x[v*T+:T]));
      assign y[v*SUM+:SUM] = SUM'($signed(quad.y[v*T+:T]));
    end

    always_ff @(posedge clk_i) begin
      parallelogram_q <= quad.ordinary && x[0+:SUM] + x[2*SUM+:SUM] == x[SUM+:SUM] + x[3*SUM+:SUM] &&
          y[0+:SUM] + y[2*SUM+:SUM] == y[SUM+:SUM] + y[3*SUM+:SUM];
    end

    // ---- Values: k, Z, attributes ----------------------------------------------------------------------------------
    logic [VALUES-1:0] used, plane_q;

    for (genvar t = 0; t < VALUES; t++) begin : gen_value
      logic [4*AP-1:0] value;

      if (t == 0) begin : gen_k
        assign used[t] = state.perspective;
      end else if (t == 1) begin : gen_z
        assign used[t] = state.depth;
      end else begin : gen_attribute
        assign used[t] = state.attributes > 4'(t - 2);
      end

      for (genvar v = 0; v < 4; v++) begin : gen_vertex
        if (t == 0) begin : gen_k
          assign value[v*AP+:AP] = {1'b0, quad.k_exp[v*PE+:PE], quad.k_sig[v*S+:S]};
        end else if (t == 1) begin : gen_z
          assign value[v*AP+:AP] = {quad.z_neg[v], quad.z_exp[v*PE+:PE], quad.z_sig[v*S+:S]};
        end else if (v == 0) begin : gen_base
          assign value[v*AP+:AP] = '0;
        end else begin : gen_attribute
          assign value[v*AP+:AP] = quad.attr[((v-1)*N+t-2)*AP+:AP];
        end
      end

      always_ff @(posedge clk_i) begin
        plane_q[t] <= !used[t] || (value[0+:AP] == value[AP+:AP] && value[2*AP+:AP] == value[3*AP+:AP]) ||
            (value[0+:AP] == value[3*AP+:AP] && value[AP+:AP] == value[2*AP+:AP]);
      end
    end

    always_ff @(posedge clk_i) plane_o <= state.skip[5] && parallelogram_q && plane_q == '1;
  end else begin : gen_no_plane
    logic unused;
    assign unused = clk_i;
    assign plane_o = 1'b0;
  end
endmodule
