// The bit-accurate model of Quadrille for a SystemVerilog bench, through DPI-C: link with the shared library quadrille_dpi.
//
// A stimulus and a response are one unsigned number each, laid out as in the suite's manifest (golden/vectors/README.md, "Records of
// the stage suites"): fields from the most significant one down, element i of an array of width W at [i*W +: W]. A record_t holds
// the record in its low bits; the bits above are 0. Widths follow from the model's configuration.
//
// Every function that returns a status_t gives OK or a code; quadrille_error() then says what was wrong, in words.
package quadrille_dpi_pkg;

  localparam int RECORD_BITS = 4096;  // the longest record of any configuration is shorter

  typedef bit [RECORD_BITS-1:0] record_t;

  typedef enum int {
    OK = 0,
    BAD_CONFIG = 1,  // a setting that is unknown or cannot be built
    BAD_NAME = 2,  // no such suite, field or value
    BAD_STIMULUS = 3,  // a number that the stage cannot be given, or bits above the record
    BAD_MODEL = 4,  // null instead of a model
    FAILED = 5  // anything else: out of memory
  } status_t;

  // ---- A model ------------------------------------------------------------------------------------------------------------
  // settings: "key=value key=value", keys of `quadrille config`; "" is the default configuration. Any number may be open.
  import "DPI-C" function int quadrille_open(
    input string settings,
    output chandle model
  );
  import "DPI-C" function void quadrille_close(input chandle model);

  // The last error in this thread, "" before the first one.
  import "DPI-C" function string quadrille_error();

  // ---- What it is -------------------------------------------------------------------------------------------------------------
  // A key in lower case (significand_bits; auto resolved) or a derived width in upper case (EXP_BITS).
  import "DPI-C" function int quadrille_value(
    input chandle model,
    input string name,
    output int value
  );
  // Bits of the two records of a suite.
  import "DPI-C" function int quadrille_record_bits(
    input chandle model,
    input string suite,
    output int stimulus_bits,
    output int response_bits
  );
  // Where a field lies: [position +: width]. index: element of an array, -1 for a field that is none.
  import "DPI-C" function int quadrille_stimulus_field(
    input chandle model,
    input string suite,
    input string name,
    input int index,
    output int position,
    output int width
  );
  import "DPI-C" function int quadrille_response_field(
    input chandle model,
    input string suite,
    input string name,
    input int index,
    output int position,
    output int width
  );

  // ---- What it computes ---------------------------------------------------------------------------------------------------
  // The response of one stage, named by its suite. A pure function: no clock, no state.
  import "DPI-C" function int quadrille_respond(
    input chandle model,
    input string suite,
    input record_t stimulus,
    output record_t response
  );

  // The same, a function a stage, named as the stages of model/ and rtl/ are.
  import "DPI-C" function int quadrille_snap(
    input chandle model,
    input record_t stimulus,
    output record_t response
  );  // suite snapping
  import "DPI-C" function int quadrille_quad_setup(
    input chandle model,
    input record_t stimulus,
    output record_t response
  );  // suite setup
  import "DPI-C" function int quadrille_tile_context(
    input chandle model,
    input record_t stimulus,
    output record_t response
  );
  import "DPI-C" function int quadrille_stamp_coverage(
    input chandle model,
    input record_t stimulus,
    output record_t response
  );  // suite coverage
  import "DPI-C" function int quadrille_forward_difference(
    input chandle model,
    input record_t stimulus,
    output record_t response
  );
  import "DPI-C" function int quadrille_normalise(
    input chandle model,
    input record_t stimulus,
    output record_t response
  );
  import "DPI-C" function int quadrille_sqrt(
    input chandle model,
    input record_t stimulus,
    output record_t response
  );
  import "DPI-C" function int quadrille_reciprocal(
    input chandle model,
    input record_t stimulus,
    output record_t response
  );
  import "DPI-C" function int quadrille_mean_value_ratios(
    input chandle model,
    input record_t stimulus,
    output record_t response
  );  // suite ratios
  import "DPI-C" function int quadrille_mean_value_weights(
    input chandle model,
    input record_t stimulus,
    output record_t response
  );  // suite weights
  import "DPI-C" function int quadrille_interpolate(
    input chandle model,
    input record_t stimulus,
    output record_t response
  );  // suite interpolation
  import "DPI-C" function int quadrille_fragment_output(
    input chandle model,
    input record_t stimulus,
    output record_t response
  );  // suite depth

endpackage
