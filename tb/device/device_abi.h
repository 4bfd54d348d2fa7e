/* The C interface between the test bench and a shared object that holds one Verilated configuration of the machine.
 * One symbol, quadrille_device_api(), returns a table of functions. Vectors are arrays of 32-bit words, least
 * significant word first, unused top bits zero. A function that can fail returns 0 for success; last_error() says what
 * happened. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { quadrille_device_abi_version = 5, quadrille_probe_count = 9, quadrille_most_lanes = 4 };

/* Status of a function that failed because the waveform cannot be written, on a full disk say; else it is 1. */
enum { quadrille_no_waveform = 2 };

/* One boundary in this clock; those in front of the pixels have one lane. words stay where they are for the device's
 * life; their contents change with every evaluation. */
typedef struct {
  uint32_t valid;                              /* bit g: lane g carries something */
  uint32_t width;                              /* bits of a lane; 0: built without probes */
  const uint32_t* words[quadrille_most_lanes]; /* NULL beyond the lanes of the machine */
} quadrille_probe;

/* Everything that leaves the machine in this clock. */
typedef struct {
  uint32_t vertex_ready, fragment_valid, fragment_mask, busy;
  uint32_t fragment_width; /* bits of a lane */
  const uint32_t* fragment_words[quadrille_most_lanes];
  quadrille_probe probe[quadrille_probe_count]; /* by Boundary (model/port/stages.hpp) */
} quadrille_sample;

typedef struct {
  const char* name;
  int64_t value;
} quadrille_constant;

typedef struct quadrille_device quadrille_device; /* opaque */

typedef struct {
  uint32_t abi_version;
  uint32_t vertex_width, state_width; /* bits of the two input vectors */

  /* A machine whose registers hold random bits from `seed`; nothing is evaluated yet. NULL: see last_error(NULL). */
  quadrille_device* (*create)(uint64_t seed);
  void (*destroy)(quadrille_device*);

  /* Inputs. They take effect at the next settle(). */
  void (*set_reset)(quadrille_device*, int active);
  void (*set_state)(quadrille_device*, const uint32_t* words);
  void (*set_vertex)(quadrille_device*, const uint32_t* words);
  void (*set_clear_hidden)(quadrille_device*, int active);
  void (*set_flush)(quadrille_device*, int active);
  void (*set_handshake)(quadrille_device*, int vertex_valid, int fragment_ready);

  /* Evaluates with the clock low; outputs then belong to the present inputs. */
  int (*settle)(quadrille_device*);
  /* The rising edge. */
  int (*clock)(quadrille_device*);
  /* A performance counter by its index, after settle(); 0 beyond the last one and on a machine without them. */
  uint32_t (*counter)(quadrille_device*, uint32_t index);
  /* The outputs after settle(). */
  const quadrille_sample* (*sample)(quadrille_device*);

  /* Waveform; trace_open fails when the object was built without tracing. The file is good when trace_close says so. */
  int (*trace_open)(quadrille_device*, const char* path);
  int (*trace_close)(quadrille_device*);

  /* Localparams of quadrille_pkg as the RTL sees them; ends with a NULL name. */
  const quadrille_constant* (*constants)(void);

  /* Text of the last failure of this device, or of create() for NULL. */
  const char* (*last_error)(const quadrille_device*);
} quadrille_device_table;

typedef const quadrille_device_table* (*quadrille_device_api_function)(void);

#ifdef __cplusplus
}
#endif
