#!/usr/bin/env python3
"""Writes the sources of the triangle machine: those of rtl/, with the files of this folder in the place of their namesakes, and a few edits.

  rtl/triangles/machine.py build/triangles
"""
import pathlib
import shutil
import sys

HERE = pathlib.Path(__file__).resolve().parent
RTL = HERE.parent

# File: (text that must occur once, its replacement).
EDITS = {
    # No law of cosines, roots, ratios, products: the weights are what normalise gives.
    "quadrille_pkg.sv": [
        ("DIFF_STAGE /*verilator public*/ = FORWARD_DIFFERENCE_STAGES + LAW_OF_COSINES_STAGES - 1;", "DIFF_STAGE /*verilator public*/ = FORWARD_DIFFERENCE_STAGES - 1;"),
        ("RATIO_STAGE /*verilator public*/ = ROOT_STAGE + PRODUCT_STAGES + FP_ADD_STAGES;", "RATIO_STAGE /*verilator public*/ = DIFF_STAGE + 1;"),
        ("OVERRIDE_STAGE /*verilator public*/ = N_STAGE + 1;", "OVERRIDE_STAGE /*verilator public*/ = DIFF_STAGE + 2;"),
        ("WEIGHT_STAGE /*verilator public*/ = OVERRIDE_STAGE + PRODUCT_STAGES + FP_ADD_STAGES + 1;", "WEIGHT_STAGE /*verilator public*/ = NORM_STAGE;"),
    ],
    # Three beats, vertex 3 is 0.
    "quadrille_vertex_assembly.sv": [
        ("count_q <= count_q + 2'd1;", "count_q <= count_q == 2'd2 ? 2'd0 : count_q + 2'd1;"),
        ("accept && count_q == 2'd3 && !flush_i", "accept && count_q == 2'd2 && !flush_i"),
        ("{id, x, y, w, ordinary,", "{id, {T'(0), x[3*T-1:0]}, {T'(0), y[3*T-1:0]}, {W'(0), w[3*W-1:0]}, ordinary,"),
        ("w_negs, w_exp[PE-1:0], w_exps, w_sig, w_sigs,\n      k_exp, k_sig, z_neg, z_exp, z_sig, attr,",
         "1'b0, w_negs[2:0], PE'(0), w_exp[PE-1:0], w_exps[2*PE-1:0], S'(0), w_sig, w_sigs[2*S-1:0],\n      PE'(0), k_exp[3*PE-1:0], S'(0), k_sig[3*S-1:0], 1'b0, z_neg[2:0], "
         "PE'(0), z_exp[3*PE-1:0], S'(0),\n      z_sig[3*S-1:0], ATTR'(0), attr[2*ATTR-1:0],"),
    ],
    # The last step has an edge, whose reach comes a clock later, as with two pairs of units. Functions 2, 3, 5 are 0. Vertices are for no
    # tile, and nobody asks whether they miss the scissor.
    "quadrille_quad_setup.sv": [
        ("END_CLOCKS = CLOCKS + PAIRS - 1;", "END_CLOCKS = CLOCKS + 1;"),
        ("(PAIRS == 1 ? load : !run_q)", "!run_q"),
        ("front_row_q, jobs.x, jobs.y, jobs.w};", "front_row_q, (4 * (2 * T + W))'(0)};"),
        ("{4{cornered && !sum_ordinary && !hull}}", "4'b0"),
        ("{lin_value, lin_gx, lin_gy};", "{lin_value, lin_gx, lin_gy} & {{VAL{1'b0}}, {VAL{1'b1}}, {2*VAL{1'b0}}, {2*VAL{1'b1}},\n"
         "      {2{{GRAD{1'b0}}, {GRAD{1'b1}}, {2*GRAD{1'b0}}, {2*GRAD{1'b1}}}}};"),
        ("visible, functions}", "visible, functions[10+20*REACH+6*LENGTH2+:6*EDGE_WIDTH],\n"
         "        functions[20*REACH+6*LENGTH2+:10] & 10'b1001110011, functions[0+:20*REACH+6*LENGTH2]}"),
    ],
    "quadrille_walk_values.sv": [
        ("lin_value_q1[g*VAL+:VAL] <= tile_q;", "lin_value_q1[g*VAL+:VAL] <= (g < 2 || g == 4) ? tile_q : '0;"),
    ],
    # Three corners; the terms stand as the quad machine's, so that some are not used.
    "quadrille_interpolate.sv": [
        ("[4*E-1:0] m_exp_i", "[3*E-1:0] m_exp_i"),
        ("[4*S-1:0] m_sig_i", "[3*S-1:0] m_sig_i"),
        ("CORNERS = (t < 3) ? 4 : 3,", "CORNERS = (t < 3) ? 3 : 2,"),
        ("V = 4 - CORNERS + c;", "V = 3 - CORNERS + c;"),
        ("endmodule", "\n  logic unused;\n  assign unused = ^{term_neg_i, term_exp_i, term_sig_i};\nendmodule"),
    ],
    # Counters of products are not the machine's; those of clocks, triangles, tiles and pixels are.
    "quadrille_performance_counters.sv": [
        ("DEPTH(quadrille_pkg::RATIO_STAGE - quadrille_pkg::ROOT_STAGE)", "DEPTH(1)"),
    ],
    # No squared lengths, dot products, squares, moves.
    "quadrille_vertex_products.sv": [
        ("{apart_x, apart_x, apart_y, apart_y}", "{w_i, x_j, x_i, w_j}"),
        *((f"          quadrille_pkg::{kind}: begin\n            {{a0, b0, c0, d0}} <= {{{first}}};\n            {{a1, b1, c1, d1}} <= {{{second}}};\n          end\n", "")
          for kind, first, second in (("DOT", "x_i, x_j, y_i, y_j", "w_i, w_j, y_i, DOT'(0)"), ("DOT_GRADIENT", "x_i, w_j, w_i, x_j", "w_i, y_j, y_i, w_j"),
                                      ("SQUARES", "x_i, x_i, y_i, y_i", "x_j, x_j, y_j, y_j"),
                                      ("MOVE", "x_i, DOT'(1), w_i, DOT'(offset_x)", "y_i, DOT'(1), w_i, DOT'(offset_y)"))),
    ],
}


def write_machine(folder):
    folder = pathlib.Path(folder)
    for pattern in ("*.sv", "include/*.svh", "default_tables/*.sv"):
        for source in RTL.glob(pattern):
            own = HERE / source.name
            target = folder / source.relative_to(RTL)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(own if own.is_file() else source, target)
    for name, edits in EDITS.items():
        text = (folder / name).read_text(encoding="utf-8")
        for old, new in edits:
            if text.count(old) != 1:
                raise SystemExit(f"rtl/{name}: {text.count(old)} times instead of once: {old}\n(an edit of rtl/triangles/machine.py)")
            text = text.replace(old, new)
        (folder / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__.strip())
        raise SystemExit(0 if sys.argv[1:] in (["-h"], ["--help"]) else 2)
    write_machine(sys.argv[1])
