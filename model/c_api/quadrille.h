/* Quadrille from C: the untimed and the clocked model, bit for bit and clock for clock (library libquadrille, CMake
 * target Quadrille::c). C99 and C++.
 *
 * A machine is created from a configuration, draws quads given as floating-point vertices, and gives fragments as the
 * integers of its output formats. Every function that can fail returns a quadrille_status; quadrille_last_error() has
 * the words. After an error the machine and every output are as they were before the call. Pointers must be valid
 * unless NULL is allowed, which is said; a NULL that is not allowed gives QUADRILLE_BAD_ARGUMENT.
 *
 * Several machines may be used at once, each by one thread at a time. No function prints, exits or lets a C++ exception
 * out.
 *
 * Binary compatibility: structs only change with QUADRILLE_ABI, which the name of the shared library follows;
 * quadrille_draw_state may grow at its end and says how long it is. An older, shorter one is accepted.
 */
#ifndef QUADRILLE_H
#define QUADRILLE_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define QUADRILLE_API __attribute__((visibility("default")))
#else
#define QUADRILLE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define QUADRILLE_ABI 2 /* of this header; see quadrille_abi() */

typedef int32_t quadrille_status;
enum {
  QUADRILLE_OK = 0,
  QUADRILLE_BAD_ARGUMENT = 1, /* NULL, an unknown name or flag */
  QUADRILLE_BAD_CONFIG = 2,   /* a setting that is unknown, out of range or cannot be built */
  QUADRILLE_BAD_STATE = 3,    /* a draw state that the configuration cannot have */
  QUADRILLE_BAD_VERTEX = 4,   /* no point of the machine's input: NaN, (0, 0, 0), out of range */
  QUADRILLE_BUSY = 5,         /* the machine is drawing */
  QUADRILLE_FAILED = 6        /* anything else, as out of memory: the machine can only be destroyed */
};

/* ---- Values ---- */

enum { QUADRILLE_MAX_ATTRIBUTES = 8, QUADRILLE_MAX_LANES = 4 };

/* Window coordinates in pixels, y down, pixel centres at +0.5, all multiplied by w; window z = z/w in [0, 1]. */
typedef struct quadrille_vertex {
  double x, y, z, w;
  double attribute[QUADRILLE_MAX_ATTRIBUTES]; /* those beyond the draw state's number are ignored */
} quadrille_vertex;

/* quad: its id. front: counter-clockwise on the screen. depth: window z times 2^depth_bits. attribute: times
 * 2^attribute_frac_bits; those beyond the draw state's number are 0. */
typedef struct quadrille_fragment {
  uint32_t quad;
  uint16_t x, y;
  uint8_t front;
  uint8_t flags; /* bit 0 on an edge, 1 on a vertex, 2 two corners, 3 two edges, 4 tie, 5 homogeneous, 6 notch, 7
                    saturated */
  uint16_t reserved;
  uint32_t depth;
  int64_t attribute[QUADRILLE_MAX_ATTRIBUTES];
} quadrille_fragment;

enum { QUADRILLE_CULL_NONE = 0, QUADRILLE_CULL_FRONT = 1, QUADRILLE_CULL_BACK = 2 };

/* What may be left out. HIDDEN needs hierarchical_z_bits, depth on, and promises a depth test LESS with writes and
 * nothing discarded or blended afterwards: the picture stays, the list of fragments does not. PLANE needs
 * plane_quads. */
enum {
  QUADRILLE_SKIP_TILES = 1,
  QUADRILLE_SKIP_QUADS = 2,
  QUADRILLE_SKIP_HIDDEN = 4,
  QUADRILLE_SKIP_WALK = 8,
  QUADRILLE_SKIP_OPERANDS = 16,
  QUADRILLE_SKIP_PLANE = 32
};

/* `size` may be that of an older header, whose struct ends behind any member from `height` on: the members that it
 * lacks are as quadrille_draw_state_init() sets them, and attributes as many of the four as the configuration has. Of a
 * newer header the bytes behind this library's members must be 0. */
typedef struct quadrille_draw_state {
  uint32_t size;                                          /* sizeof(quadrille_draw_state) of the caller */
  int32_t width, height;                                  /* viewport, at most 2^viewport_bits each */
  int32_t scissor_x0, scissor_y0, scissor_x1, scissor_y1; /* half-open rectangle inside the viewport */
  int32_t cull;
  int32_t perspective; /* 1: attributes are perspective-correct */
  int32_t depth;       /* 1: window z is computed, and clipped to [znear, zfar] */
  int32_t attributes;  /* in use, at most attribute_slots */
  uint32_t skip;
  double znear, zfar; /* 0 <= znear <= zfar <= 1 */
} quadrille_draw_state;

/* ---- The library ---- */

/* "0.1.0"; valid for ever. */
QUADRILLE_API const char* quadrille_version(void);
/* QUADRILLE_ABI of the library: other structs than this header's if it is another. */
QUADRILLE_API uint32_t quadrille_abi(void);
/* What was wrong in the last call of this thread that failed; "" before. Valid until the next one fails. */
QUADRILLE_API const char* quadrille_last_error(void);

/* A configuration is text: lines of `key = value` as in a configuration file, or "key=value key=value", each key once;
 * NULL or "" is the default one. Keys: README.md of model/, or `quadrille config`. The value of a key (auto resolved)
 * or, in upper case, of a derived width. */
QUADRILLE_API quadrille_status quadrille_config_value(const char* config, const char* name, int32_t* value);

/* A draw state for a viewport of that size: all of it drawn, four attributes, depth, perspective, every skip that keeps
 * the list of fragments. `size`: sizeof(quadrille_draw_state) of the caller; so many bytes are written. */
QUADRILLE_API quadrille_status quadrille_draw_state_init(quadrille_draw_state* state, size_t size, int32_t width,
                                                         int32_t height);

/* ---- The untimed model ---- */

typedef struct quadrille_untimed quadrille_untimed;

/* *machine is NULL after an error. With the state of quadrille_draw_state_init() for 512 x 512, or as much of it as the
 * configuration has. */
QUADRILLE_API quadrille_status quadrille_untimed_create(const char* config, quadrille_untimed** machine);
QUADRILLE_API void quadrille_untimed_destroy(quadrille_untimed* machine); /* NULL: nothing */
/* For quads drawn from now on; what is hidden stays so. */
QUADRILLE_API quadrille_status quadrille_untimed_set_state(quadrille_untimed* machine,
                                                           const quadrille_draw_state* state);
/* Forgets what is hidden, with a clear of the depth buffer. */
QUADRILLE_API quadrille_status quadrille_untimed_clear_hidden(quadrille_untimed* machine);
/* Draws `quads` quads of four vertices each, with ids from first_id; all or, after an error, none of them. */
QUADRILLE_API quadrille_status quadrille_untimed_draw(quadrille_untimed* machine, uint32_t first_id,
                                                      const quadrille_vertex* vertices, size_t quads);
/* Fragments that wait to be taken, in the machine's order. take: at most `capacity` of them, *taken is how many. */
QUADRILLE_API quadrille_status quadrille_untimed_pending(const quadrille_untimed* machine, size_t* fragments);
QUADRILLE_API quadrille_status quadrille_untimed_take(quadrille_untimed* machine, quadrille_fragment* fragments,
                                                      size_t capacity, size_t* taken);
/* Counters since creation by name; counter_name: NULL past the last one. */
QUADRILLE_API const char* quadrille_untimed_counter_name(uint32_t index);
QUADRILLE_API quadrille_status quadrille_untimed_counter(const quadrille_untimed* machine, const char* name,
                                                         uint64_t* value);

/* ---- The clocked model ----
 *
 * Two ways to drive it. With a queue: push() quads, then run(), or clock() by clock() with a pattern of one's own;
 * fragments that are accepted wait to be taken. Or port by port, as a test bench does beside the RTL: see below. */

typedef struct quadrille_clocked quadrille_clocked;

/* As quadrille_untimed_create(), after a reset and idle: with hierarchical_z_bits its places are wiped. */
QUADRILLE_API quadrille_status quadrille_clocked_create(const char* config, quadrille_clocked** machine);
QUADRILLE_API void quadrille_clocked_destroy(quadrille_clocked* machine); /* NULL: nothing */
/* With an empty queue and no quad under way, else QUADRILLE_BUSY; what is hidden stays so. */
QUADRILLE_API quadrille_status quadrille_clocked_set_state(quadrille_clocked* machine,
                                                           const quadrille_draw_state* state);
/* Appends quads to the queue; all or, after an error, none of them. */
QUADRILLE_API quadrille_status quadrille_clocked_push(quadrille_clocked* machine, uint32_t first_id,
                                                      const quadrille_vertex* vertices, size_t quads);

/* Outputs of this clock, before its edge; they depend on no input of the clock. */
typedef struct quadrille_outputs {
  uint8_t vertex_ready, fragment_valid, busy, reserved;
  uint32_t fragment_mask; /* lanes that have a fragment, when fragment_valid */
  quadrille_fragment fragment[QUADRILLE_MAX_LANES];
} quadrille_outputs;
QUADRILLE_API quadrille_status quadrille_clocked_outputs(const quadrille_clocked* machine, quadrille_outputs* outputs);

/* Inputs of a clock. */
enum {
  QUADRILLE_RESET = 1,
  QUADRILLE_VERTEX_VALID = 2,   /* the next beat of the queue is on offer, if there is one */
  QUADRILLE_FRAGMENT_READY = 4, /* what is on offer at the fragment port is accepted */
  QUADRILLE_CLEAR_HIDDEN = 8,   /* with a clear of the depth buffer; QUADRILLE_BUSY while the machine is */
  QUADRILLE_FLUSH = 16          /* a quad of which some beats were taken, and not all before this clock, is discarded */
};
/* One clock edge. Reset empties the queue and keeps fragments that wait to be taken. */
QUADRILLE_API quadrille_status quadrille_clocked_clock(quadrille_clocked* machine, uint32_t inputs);
/* Clocks without gap or stall until the queue is empty and nothing is on its way, max_clocks at most. *clocks (may be
 * NULL): how many it were. */
QUADRILLE_API quadrille_status quadrille_clocked_run(quadrille_clocked* machine, uint64_t max_clocks, uint64_t* clocks);
QUADRILLE_API quadrille_status quadrille_clocked_pending(const quadrille_clocked* machine, size_t* fragments);
QUADRILLE_API quadrille_status quadrille_clocked_take(quadrille_clocked* machine, quadrille_fragment* fragments,
                                                      size_t capacity, size_t* taken);
/* The performance counters since reset, by the names in `rtl/SPEC.md`; in 64 bits, whether the
 * configuration has them in hardware or not. */
QUADRILLE_API const char* quadrille_clocked_counter_name(uint32_t index);
QUADRILLE_API quadrille_status quadrille_clocked_counter(const quadrille_clocked* machine, const char* name,
                                                         uint64_t* value);

/* ---- The clocked model, port by port ----
 *
 * Ports are the vectors of
 * rtl/quadrille.sv: 32-bit words, least significant first, bits above a port are 0. Only types that DPI-C maps to, so
 * that a SystemVerilog bench imports these functions as they are (tb/verify/dpi/quadrille_machine_pkg.sv). The queue
 * and the fragments that wait have no part in it. */

enum {
  QUADRILLE_VERTEX_WORDS = 32,  /* vertex_i */
  QUADRILLE_STATE_WORDS = 8,    /* state_i */
  QUADRILLE_FRAGMENT_WORDS = 64 /* fragment_o, the lanes together */
};

/* The four beats vertex_i of a quad, snapped as the draw state says. positions: x, y, z, w of each vertex; attributes:
 * QUADRILLE_MAX_ATTRIBUTES of each; beats: QUADRILLE_VERTEX_WORDS of each. */
QUADRILLE_API quadrille_status quadrille_quad_port(const quadrille_clocked* machine, uint32_t id,
                                                   const double* positions, const double* attributes, uint32_t* beats);
/* state_i. As set_state, but nothing happens when it is the one there is, so that it may be given in every clock. The
 * viewport is as large as the configuration's. */
QUADRILLE_API quadrille_status quadrille_clocked_state_port(quadrille_clocked* machine, const uint32_t* state);
/* What the output ports have in this clock, before its edge; fragment and mask are 0 when not valid, and so are lanes
 * without fragment. */
QUADRILLE_API quadrille_status quadrille_clocked_output_ports(const quadrille_clocked* machine, int32_t* vertex_ready,
                                                              int32_t* fragment_valid, int32_t* busy,
                                                              int32_t* fragment_mask, uint32_t* fragment);
/* flush_i of the next quadrille_clocked_clock_ports(), which takes it back: beats of a quad that is not complete before
 * that clock are discarded, and one that is taken in it. */
QUADRILLE_API quadrille_status quadrille_clocked_flush_port(quadrille_clocked* machine, int32_t flush);
/* The clock edge. `vertex` is looked at when vertex_valid alone; clear_hidden is ignored while busy, as the RTL does.
 */
QUADRILLE_API quadrille_status quadrille_clocked_clock_ports(quadrille_clocked* machine, int32_t reset,
                                                             int32_t clear_hidden, int32_t vertex_valid,
                                                             const uint32_t* vertex, int32_t fragment_ready);

#ifdef __cplusplus
}
#endif

#endif
