/* quadrille.h as a C11 compiler sees it: the layout of its structs, which other languages write down by hand, and one
 * quad. */
#include "model/c_api/quadrille.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(sizeof(quadrille_vertex) == 96 && offsetof(quadrille_vertex, attribute) == 32, "vertex");
_Static_assert(sizeof(quadrille_fragment) == 80 && offsetof(quadrille_fragment, x) == 4 &&
                   offsetof(quadrille_fragment, front) == 8 && offsetof(quadrille_fragment, flags) == 9 &&
                   offsetof(quadrille_fragment, depth) == 12 && offsetof(quadrille_fragment, attribute) == 16,
               "fragment");
_Static_assert(sizeof(quadrille_draw_state) == 64 && offsetof(quadrille_draw_state, cull) == 28 &&
                   offsetof(quadrille_draw_state, skip) == 44 && offsetof(quadrille_draw_state, znear) == 48,
               "draw state");
_Static_assert(sizeof(quadrille_outputs) == 328 && offsetof(quadrille_outputs, fragment) == 8, "outputs");

static int failures = 0;

static void check(int ok, const char* what) {
  if (ok) return;
  printf("c_test: %s; last error: %s\n", what, quadrille_last_error());
  ++failures;
}

int main(void) {
  /* A square of 4 x 4 pixels, its corners on pixel centres' lines: y down, so this order is counter-clockwise on the
   * screen. */
  const quadrille_vertex square[4] = {
      {4, 4, 0.5, 1, {1}}, {4, 8, 0.5, 1, {1}}, {8, 8, 0.5, 1, {1}}, {8, 4, 0.5, 1, {1}}};
  check(quadrille_abi() == QUADRILLE_ABI, "the library is of another ABI");
  check(strcmp(quadrille_last_error(), "") == 0, "an error before the first call");

  quadrille_untimed* untimed = NULL;
  quadrille_clocked* clocked = NULL;
  quadrille_draw_state state;
  check(quadrille_untimed_create("attribute_slots = 1 # one\n", &untimed) == QUADRILLE_OK, "untimed");
  check(quadrille_clocked_create("attribute_slots=1", &clocked) == QUADRILLE_OK, "clocked");
  check(quadrille_draw_state_init(&state, sizeof state, 16, 16) == QUADRILLE_OK, "draw state");
  check(quadrille_untimed_set_state(untimed, &state) == QUADRILLE_BAD_STATE, "four attributes of one slot");
  state.attributes = 1;
  check(quadrille_untimed_set_state(untimed, &state) == QUADRILLE_OK, "state of the untimed model");
  check(quadrille_clocked_set_state(clocked, &state) == QUADRILLE_OK, "state of the clocked model");

  quadrille_fragment drawn[20], clocked_out[20];
  size_t count = 0, clocked_count = 0;
  check(quadrille_untimed_draw(untimed, 7, square, 1) == QUADRILLE_OK, "draw");
  check(quadrille_untimed_take(untimed, drawn, 20, &count) == QUADRILLE_OK && count == 16, "16 pixels");
  check(quadrille_clocked_push(clocked, 7, square, 1) == QUADRILLE_OK, "push");
  check(quadrille_clocked_run(clocked, 10000, NULL) == QUADRILLE_OK, "run");
  check(quadrille_clocked_take(clocked, clocked_out, 20, &clocked_count) == QUADRILLE_OK && clocked_count == 16,
        "16 of the clocked model");
  for (size_t i = 0; i < count && i < clocked_count; ++i) {
    const quadrille_fragment* f = &drawn[i];
    check(f->quad == 7 && f->x >= 4 && f->x < 8 && f->y >= 4 && f->y < 8 && f->front == 1, "id, place and face");
    /* What is the same everywhere is exact: 1 and 0.5 with 24 fraction bits. */
    check(f->attribute[0] == 1 << 24 && f->attribute[1] == 0, "attribute 1");
    check(f->depth == 1 << 23, "depth 0.5");
    check(memcmp(f, &clocked_out[i], sizeof *f) == 0, "both models alike");
  }
  quadrille_untimed_destroy(untimed);
  quadrille_clocked_destroy(clocked);
  quadrille_untimed_destroy(NULL);
  quadrille_clocked_destroy(NULL);
  if (failures == 0) printf("c_test: %u fragments of each model\n", (unsigned)count);
  return failures != 0;
}
