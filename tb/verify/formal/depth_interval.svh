  // depth_interval: near_o and far_o, in units of 2^DROP codes, are bounds of every depth of a quad between its corners' codes, and the closest ones;
  // a near code before all ones and a far one of all ones are those of depths at 1 and beyond. lowers_o only where far_o says something and
  // neither limit cuts. One clock from any contents. Assumed: corners' codes as snapping gives them, the least not above the greatest.
  localparam int WIDE = CODE + 1;
  (* anyseq *) logic [CODE-1:0] z;  // a depth of the quad
  logic [WIDE-1:0] z_q, low_q, high_q;  // not below 0
  logic [WIDE-1:0] near_codes, far_codes;
  logic cuts_q, ordinary_q;

  always_ff @(posedge clk_i) begin
    z_q <= $signed(z) < 0 ? '0 : WIDE'(z);
    low_q <= $signed(low_i) < 0 ? '0 : WIDE'(low_i);
    high_q <= $signed(high_i) < 0 ? '0 : WIDE'(high_i);
    cuts_q <= limits_i[LIMITS-2] || limits_i[LIMITS-3];
    ordinary_q <= ordinary_i;
  end

  assign near_codes = WIDE'(near_o) << DROP;
  assign far_codes = WIDE'(far_o) << DROP;

  always_comb begin
    assume ($signed(low_i) >= -1 && $signed(low_i) <= $signed(high_i) && $signed(high_i) <= (1 << DB) + 1);
    assume ($signed(low_i) <= $signed(z) && $signed(z) <= $signed(high_i));
    assert (near_codes <= z_q);
    assert (near_o == UNKNOWN - H'(1) || near_codes + WIDE'(1 << DROP) > low_q);
    assert (far_o == UNKNOWN || far_codes >= z_q);
    assert (far_o == '0 || far_codes - WIDE'(1 << DROP) < high_q);
    assert (near_o <= UNKNOWN - H'(1));
    assert (!lowers_o || (ordinary_q && !cuts_q && far_o != UNKNOWN));
  end
