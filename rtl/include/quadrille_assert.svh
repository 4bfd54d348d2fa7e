// SPDX-License-Identifier: Apache-2.0
// `QUADRILLE_ASSERT(label, condition, "message"): a statement of a clocked block. Yosys takes no
// message, Icarus Verilog neither message nor label.
`ifndef QUADRILLE_ASSERT_SVH
`define QUADRILLE_ASSERT_SVH

`ifdef YOSYS
`define QUADRILLE_ASSERT(label, condition, message) label: assert (condition);
`elsif __ICARUS__
`define QUADRILLE_ASSERT(label, condition, message) begin : label assert (condition); end
`else
`define QUADRILLE_ASSERT(label, condition, message) label: assert (condition) else $error("%s", message);
`endif

`endif
