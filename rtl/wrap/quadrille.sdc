# quadrille_axi4: one clock, which its user drives; aresetn is synchronous. The period is 60 MHz, in ns: put your own
# here. Half of it is left to the logic outside, in front of the inputs and behind the outputs.
set period 16.667
set outside [expr {$period / 2}]
create_clock -name aclk -period $period [get_ports aclk]
set_input_delay -clock aclk $outside [get_ports {aresetn
    s_axi_awaddr* s_axi_awvalid s_axi_wdata* s_axi_wstrb* s_axi_wvalid s_axi_bready s_axi_araddr* s_axi_arvalid
    s_axi_rready s_axis_vertex_tdata* s_axis_vertex_tkeep* s_axis_vertex_tlast s_axis_vertex_tvalid
    m_axis_fragment_tready}]
set_output_delay -clock aclk $outside [all_outputs]
