// SPDX-License-Identifier: Apache-2.0
// Whole product of two significands, each with its top bit set or 0. Exact, combinational.
//
// Up to BLOCK bits one multiplier does it, the width of a DSP block. Of wider significands the block takes BLOCK bits
// behind the leading one, and adders take the LOW bits below them (small_multiply), which would take three blocks more:
//
//     a = 2^R + a',  a' = ah 2^LOW + al,  b alike,  R = S - 1
//     a b = 2^(2R) + (a' + b') 2^R + ah bh 2^(2 LOW) + (al bh 2^LOW + a' bl)
//
// No sum goes whole into another sum: Yosys would make carry-save adders of the three summands, two LUTs a bit where a
// carry chain takes one.
module quadrille_significand_product #(
    parameter int S = quadrille_pkg::SIGNIFICAND_BITS,
    parameter int BLOCK = 18
) (
    input logic [S-1:0] a_i,
    input logic [S-1:0] b_i,
    output logic [2*S-1:0] product_o
);
  if (S <= BLOCK) begin : gen_block
    assign product_o = (2 * S)'(a_i) * (2 * S)'(b_i);
  end else begin : gen_strips
    localparam int R = S - 1;
    localparam int LOW = R - BLOCK;
    logic nonzero;
    logic [R-1:0] a_rest, b_rest;
    logic [BLOCK-1:0] a_high, b_high;

    assign nonzero = a_i[R] && b_i[R];
    assign a_rest = a_i[R-1:0];
    assign b_rest = b_i[R-1:0];
    assign a_high = a_rest[R-1-:BLOCK];
    assign b_high = b_rest[R-1-:BLOCK];

    // ---- Block and leading ones -------------------------------------------------------------------------------------
    logic [2*BLOCK-1:0] block;
    logic [R:0] ones;
    logic [S:0] upper;  // from 2^R on

    assign block = (2 * BLOCK)'(a_high) * (2 * BLOCK)'(b_high);
    assign ones = {1'b0, a_rest} + {1'b0, b_rest};
    assign upper = {2'b01 + {1'b0, ones[R]}, ones[R-1:0]} + (S + 1)'(block >> (R - 2 * LOW));

    // ---- Strips -----------------------------------------------------------------------------------------------------
    if (LOW == 0) begin : gen_none
      assign product_o = nonzero ? {upper, block[R-1:0]} : '0;
    end else begin : gen_some
      logic [R+LOW:0] a_strip;  // a' bl and al bh, signed: a carry that waits may be all of it
      logic [BLOCK+LOW:0] b_strip;
      logic a_carry, b_carry;  // b_carry is one of 2^LOW
      logic [R+LOW+1:0] strips;  // without b_carry
      logic [2*S-LOW-1:0] joined;  // from 2^LOW on

      if (LOW == 1) begin : gen_bit
        assign a_strip = b_rest[0] ? {2'b0, a_rest} : '0;
        assign b_strip = a_rest[0] ? {2'b0, b_high} : '0;
        assign {a_carry, b_carry} = '0;
      end else begin : gen_digits
        localparam int DIGITS = LOW / 2 + 1;
        logic [2*DIGITS-1:0] a_digits, b_digits;

        quadrille_radix4_digits #(.NUMBER_BITS(LOW)) u_a_digits (.number_i(a_rest[LOW-1:0]), .digits_o(a_digits));
        quadrille_radix4_digits #(.NUMBER_BITS(LOW)) u_b_digits (.number_i(b_rest[LOW-1:0]), .digits_o(b_digits));
        quadrille_small_multiply #(.FACTOR_BITS(R + 1), .NUMBER_BITS(LOW)) u_a_strip (
            .factor_i({1'b0, a_rest}), .digits_i(b_digits), .product_o(a_strip), .carry_o(a_carry)
        );
        quadrille_small_multiply #(.FACTOR_BITS(BLOCK + 1), .NUMBER_BITS(LOW)) u_b_strip (
            .factor_i({1'b0, b_high}), .digits_i(a_digits), .product_o(b_strip), .carry_o(b_carry)
        );
      end

      // {x, 1} + {y, carry} is an adder whose carry-in is used.
      assign strips = (R + LOW + 2)'((
          {(R + LOW + 2)'($signed(a_strip)), 1'b1} + {(R + 2)'($signed(b_strip)), LOW'(0), a_carry}) >> 1);
      assign joined = (2 * S - LOW)'((
          {upper, block[R-2*LOW-1:0], LOW'(0), 1'b1} + {(2 * S - LOW)'($signed(strips[R+LOW+1:LOW])), b_carry}) >> 1);
      assign product_o = nonzero ? {joined, strips[LOW-1:0]} : '0;
    end
  end
endmodule
