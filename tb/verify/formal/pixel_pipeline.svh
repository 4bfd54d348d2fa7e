  // pixel_pipeline: a pixel that enters is in the last register LATENCY clocks on, drawn or discarded, and never else; a lane without a pixel has no
  // fragment; pixels of a clock are either pushed or discarded, once: so pixel_emit gets each place back once (with fragment_fifo's freed_o). An end
  // beat leaves as many clocks on, and two clocks before its slot is at reads.outputs, and released with it; three clocks before that it is at reads.base.
  // From any contents of all registers, LATENCY clocks on. The units of arithmetic are left out: their outputs are anything (`cut`). Assumed: no reset.
  always_comb assume (rst_ni);

  localparam int CLOCKS = quadrille_pkg::LATENCY;
  logic [P-1:0] pixel_spec;
  logic end_spec;
  logic [SLOT-1:0] slot_spec, base_slot_spec, release_slot_spec;

  quadrille_delay_line #(.WIDTH(P + 1), .DEPTH(CLOCKS)) u_pixel_spec (.clk_i, .data_i({pixels.valid, pixels.end_token}), .data_o({pixel_spec, end_spec}));
  quadrille_delay_line #(.WIDTH(SLOT), .DEPTH(CLOCKS - 2)) u_slot_spec (.clk_i, .data_i(tile.slot), .data_o(slot_spec));
  quadrille_delay_line #(.WIDTH(SLOT), .DEPTH(CLOCKS - 5)) u_base_slot_spec (.clk_i, .data_i(tile.slot), .data_o(base_slot_spec));

  quadrille_delay_line #(.WIDTH(SLOT), .DEPTH(CLOCKS)) u_release_spec (.clk_i, .data_i(tile.slot), .data_o(release_slot_spec));

  always_comb begin
    assert (pixel == pixel_spec);
    assert ((fragment_valid_o & ~pixel_spec) == '0);
    assert (discard_o == (pixel_spec != '0 && fragment_valid_o == '0));
    assert (release_o == end_spec);
    assert (release_slot_o == release_slot_spec);
    assert (reads.outputs == slot_spec);
    assert (reads.base == base_slot_spec);
  end
