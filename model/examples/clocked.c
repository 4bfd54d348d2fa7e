/* Draws the quads of a file with the clocked model and says how many clocks it took. Input and output as of
 * untimed.cpp. */
#include <quadrille/quadrille.h>
#include <stdio.h>
#include <stdlib.h>

static void check(quadrille_status status) {
  if (status == QUADRILLE_OK) return;
  fprintf(stderr, "%s\n", quadrille_last_error());
  exit(1);
}

int main(int argc, char** argv) {
  quadrille_clocked* machine;
  quadrille_draw_state state;
  check(quadrille_clocked_create("pixels_per_clock = 2", &machine));
  check(quadrille_draw_state_init(&state, sizeof state, 64, 64));
  check(quadrille_clocked_set_state(machine, &state));

  FILE* file = argc > 1 ? fopen(argv[1], "r") : stdin;
  if (file == NULL) return perror(argv[1]), 1;
  for (uint32_t id = 0;; ++id) {
    quadrille_vertex quad[4] = {{0}};
    int read = 0;
    for (quadrille_vertex* v = quad; v < quad + 4; ++v)
      read += fscanf(file, "%lf %lf %lf %lf", &v->x, &v->y, &v->z, &v->w);
    for (quadrille_vertex* v = quad; v < quad + 4; ++v)
      for (int i = 0; i < 4; ++i) read += fscanf(file, "%lf", &v->attribute[i]);
    if (read != 32) break;
    check(quadrille_clocked_push(machine, id, quad, 1));
  }
  uint64_t clocks;
  check(quadrille_clocked_run(machine, UINT64_MAX, &clocks));

  quadrille_fragment f;
  for (size_t taken; check(quadrille_clocked_take(machine, &f, 1, &taken)), taken == 1;)
    printf("%u %u %u %u %u %u %lld %lld %lld %lld\n", f.quad, f.x, f.y, f.front, f.flags, f.depth,
           (long long)f.attribute[0], (long long)f.attribute[1], (long long)f.attribute[2], (long long)f.attribute[3]);
  fprintf(stderr, "%llu clocks\n", (unsigned long long)clocks);
  quadrille_clocked_destroy(machine);
}
