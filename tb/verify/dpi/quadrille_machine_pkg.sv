// The clocked model of the whole machine for a SystemVerilog bench, through DPI-C: link with the shared library libquadrille.so.
//
// Ports are those of rtl/quadrille.sv in the low bits of wider vectors, 0 above. In every clock: output_ports (compare), choose the
// inputs, clock_ports (with the edge that the RTL gets). Contracts and errors: <quadrille/quadrille.h>, whose functions these are.
package quadrille_machine_pkg;

  localparam int OK = 0;  // of a status; anything else: quadrille_last_error() has the words

  typedef bit [1023:0] vertex_port_t;  // vertex_i
  typedef bit [255:0] state_port_t;  // state_i
  typedef bit [2047:0] fragment_port_t;  // fragment_o

  // config: "key=value key=value" or the text of a configuration file; "" is the default configuration. After a reset and idle.
  import "DPI-C" function int quadrille_clocked_create(
    input string config_text,
    output chandle machine
  );
  import "DPI-C" function void quadrille_clocked_destroy(input chandle machine);
  import "DPI-C" function string quadrille_last_error();

  // The four beats of a quad: of each vertex {x, y, z, w} in window coordinates and its attributes, snapped.
  import "DPI-C" function int quadrille_quad_port(
    input chandle machine,
    input int unsigned id,
    input real positions[4][4],
    input real attributes[4][8],
    output vertex_port_t beats[4]
  );
  // May be called in every clock: an error only when another state is given while the machine is busy.
  import "DPI-C" function int quadrille_clocked_state_port(
    input chandle machine,
    input state_port_t state
  );
  // Before the edge; fragments and mask are 0 when not valid, and so are lanes without fragment.
  import "DPI-C" function int quadrille_clocked_output_ports(
    input chandle machine,
    output int vertex_ready,
    output int fragment_valid,
    output int busy,
    output int fragment_mask,
    output fragment_port_t fragment
  );
  // flush_i of the next edge alone.
  import "DPI-C" function int quadrille_clocked_flush_port(
    input chandle machine,
    input int flush
  );
  // The edge. clear_hidden is ignored while busy, as in the RTL.
  import "DPI-C" function int quadrille_clocked_clock_ports(
    input chandle machine,
    input int reset,
    input int clear_hidden,
    input int vertex_valid,
    input vertex_port_t vertex,
    input int fragment_ready
  );
  // A performance counter by name (rtl/SPEC.md, Performance counters).
  import "DPI-C" function int quadrille_clocked_counter(
    input chandle machine,
    input string name,
    output longint unsigned value
  );

endpackage
