// SPDX-License-Identifier: Apache-2.0
// What the simulation has for the ECP5's own cells.

// The bench clocks CLKI as fast as CLKOP; CLKOS is CLKOP, divided. So the oscillator is too fast here, and only the
// ratio of the two clocks is that of the board.
/* verilator lint_off UNUSEDPARAM */
/* verilator lint_off UNUSEDSIGNAL */
/* verilator lint_off DECLFILENAME */
module EHXPLLL #(
    parameter int CLKI_DIV = 1, CLKFB_DIV = 1, CLKOP_DIV = 8, CLKOS_DIV = 8, CLKOP_CPHASE = 0, CLKOS_CPHASE = 0,
    parameter FEEDBK_PATH = "CLKOP", CLKOP_ENABLE = "ENABLED", CLKOS_ENABLE = "DISABLED"
) (
    input logic CLKI, CLKFB, RST, STDBY, PHASESEL0, PHASESEL1, PHASEDIR, PHASESTEP, PHASELOADREG, PLLWAKESYNC, ENCLKOP,
    output logic CLKOP, CLKOS, LOCK
);
  localparam int RATIO = CLKOS_DIV / CLKOP_DIV;
  int count = 0;
  assign CLKOP = CLKI;
  always_ff @(posedge CLKI) begin
    count <= count == 16 * RATIO - 1 ? 0 : count + 1;
    CLKOS <= count % RATIO < RATIO / 2;
    if (count == 10 * RATIO) LOCK <= 1'b1;
  end
endmodule

module ODDRX1F (
    input logic SCLK, RST, D0, D1,
    output logic Q
);
  logic first, second;
  assign Q = SCLK ? first : second;
  always_ff @(posedge SCLK) {first, second} <= {D0, D1};
endmodule
