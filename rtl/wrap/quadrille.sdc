# quadrille_axi4: one clock, which its user drives; aresetn is synchronous. The period is 60 MHz, in ns: put your own
# here. Half of it is left to the logic outside, in front of the inputs and behind the outputs.
set period 16.667
create_clock -name aclk -period $period [get_ports aclk]
set inputs [remove_from_collection [all_inputs] [get_ports aclk]]
set_input_delay -clock aclk [expr {$period / 2}] $inputs
set_output_delay -clock aclk [expr {$period / 2}] [all_outputs]
