// Coverage: every pixel exactly once.
//
// Random meshes that tile a rectangle (quads and triangles, convex and concave, both windings, shared edges and
// vertices, many of them at pixel centres) are drawn through snapping, quad_setup, TileWalk and stamp_coverage; every
// pixel of the viewport must be drawn once inside the rectangle, top-left rule at its border, and never outside.
// Samples are the pixels whose centre lies in the closed rectangle. Exact ties are samples whose centre lies on an edge
// of the mesh, counted from the mesh's integers, independently of the model.
//
// --grid 1: all 25^4 quads of a 5x5 grid, every pixel of the grid, against exact_coverage of the reference.
#include "tb/verify/campaign/campaign_options.hpp"

#include "golden/reference/exact_coverage.hpp"
#include "golden/scenes/random_mesh.hpp"
#include "model/front/covered_pixels.hpp"
#include "model/front/quad_setup.hpp"
#include "model/front/stamp_coverage.hpp"
#include "model/port/snap.hpp"
#include "model/support/parallel.hpp"
#include "model/support/prng.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>

namespace quadrille::campaign {
namespace {

/// Calls f(x, y, front, tie) for every pixel that the model covers.
template <class F>
void cover(const SnappedQuad& quad, const Config& config, const DrawState& state, TileWalk& walk, F f) {
  walk_tiles(walk, quad_setup(quad, config, state), [&](const TileEntry& tile) {
    for_each_covered_pixel(tile, walk.constants(), config, state, [&](const CoveredPixel& at) {
      f(tile.tile_x * config.tile() + at.dx, tile.tile_y * config.tile() + at.row, at.front, at.tie);
    });
  });
}

struct Counts {
  std::uint64_t meshes = 0, quads = 0, triangles = 0, concave = 0, clockwise = 0;
  std::uint64_t samples = 0, edge_ties = 0, vertices = 0, tie_flags = 0, outside = 0;
  std::uint64_t gaps = 0, doubles = 0, strays = 0;  ///< strays: drawn where nothing should be

  Counts& operator+=(const Counts& o) {
    meshes += o.meshes, quads += o.quads, triangles += o.triangles, concave += o.concave, clockwise += o.clockwise;
    samples += o.samples, edge_ties += o.edge_ties, vertices += o.vertices, tie_flags += o.tie_flags,
        outside += o.outside;
    gaps += o.gaps, doubles += o.doubles, strays += o.strays;
    return *this;
  }
};

golden::RandomMeshOptions mesh_options(std::uint64_t index, golden::Prng& rng) {
  golden::RandomMeshOptions o;
  o.width = o.height = 256;
  constexpr int cells[] = {64, 48, 24, 60, 12, 56};
  o.columns = cells[index % 6];
  o.rows = cells[(index + rng.below(3)) % 6];
  o.jitter = rng.uniform(0.1, 1.2);
  constexpr double ties[] = {1, 1, 0.5, 1, 0, 1};
  o.tie_share = ties[(index / 2) % 6];
  o.triangle_share = rng.uniform(0, 0.6);
  o.vary_w = rng.chance(0.5);
  return o;
}

Counts check_mesh(std::uint64_t seed, std::uint64_t index) {
  golden::Prng rng(seed * 1'000'003 + index);
  const golden::RandomMeshOptions o = mesh_options(index, rng);
  const golden::RandomMesh mesh = golden::make_random_mesh(rng.next(), o);
  Config config;
  config.tile_log2 = static_cast<int>(rng.integer(2, 4));
  DrawState state;
  state.width = state.scissor_x1 = o.width;
  state.height = state.scissor_y1 = o.height;
  if (rng.chance(0.2)) state.skip = 0;
  Counts n;
  n.meshes = 1;
  n.quads = mesh.quads.size();
  n.triangles = mesh.triangles;
  n.concave = mesh.concave;
  n.clockwise = mesh.clockwise;

  const auto pixel = [&](int x, int y) { return static_cast<std::size_t>(y * o.width + x); };
  std::vector<int> drawn(pixel(0, o.height)), tie(drawn.size()), shared(drawn.size());
  TileWalk walk(config, state);
  for (const WindowQuad& quad : mesh.quads)
    cover(snap_quad(quad, config, state), config, state, walk, [&](int x, int y, bool, bool on_tie) {
      ++drawn[pixel(x, y)];
      n.tie_flags += on_tie;
    });

  // Which centres lie on edges and on vertices of several cells, from the mesh's own integers (1/256 px).
  std::vector<int> users(mesh.vertices.size());
  for (const auto& cell : mesh.cells) {
    std::array<int, 4> corners = cell;
    std::ranges::sort(corners);
    const auto repeated = std::unique(corners.begin(), corners.end());
    for (auto c = corners.begin(); c != repeated; ++c) ++users[static_cast<std::size_t>(*c)];
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& a = mesh.vertices[static_cast<std::size_t>(cell[i])];
      const auto& b = mesh.vertices[static_cast<std::size_t>(cell[(i + 1) & 3])];
      const auto first = [](std::int64_t v) { return (v - 128 + 255) >> 8; };
      const auto last = [](std::int64_t v) { return (v - 128) >> 8; };
      for (std::int64_t y = first(std::min(a[1], b[1])); y <= last(std::max(a[1], b[1])); ++y)
        for (std::int64_t x = first(std::min(a[0], b[0])); x <= last(std::max(a[0], b[0])); ++x) {
          const std::int64_t cx = 256 * x + 128, cy = 256 * y + 128;
          if ((b[0] - a[0]) * (cy - a[1]) == (b[1] - a[1]) * (cx - a[0]) && x < o.width && y < o.height)
            tie[pixel(static_cast<int>(x), static_cast<int>(y))] = 1;
        }
    }
  }
  for (std::size_t v = 0; v < users.size(); ++v) {
    const auto& p = mesh.vertices[v];
    if (users[v] < 2 || ((p[0] - 128) & 255) != 0 || ((p[1] - 128) & 255) != 0) continue;
    const std::int64_t x = (p[0] - 128) >> 8, y = (p[1] - 128) >> 8;
    if (x >= 0 && x < o.width && y >= 0 && y < o.height) shared[pixel(static_cast<int>(x), static_cast<int>(y))] = 1;
  }

  for (int y = 0; y < o.height; ++y)
    for (int x = 0; x < o.width; ++x) {
      const std::size_t at = pixel(x, y);
      const std::int64_t cx = std::int64_t{256} * x + 128, cy = std::int64_t{256} * y + 128;
      const bool inside = cx >= mesh.x0 && cx <= mesh.x1 && cy >= mesh.y0 && cy <= mesh.y1;
      const int expected = mesh.expected(x, y) ? 1 : 0;
      (inside ? n.samples : n.outside) += 1;
      n.edge_ties += inside && tie[at];
      n.vertices += inside && shared[at];
      n.gaps += expected == 1 && drawn[at] == 0;
      n.doubles += drawn[at] > 1;
      n.strays += expected == 0 && drawn[at] != 0;
    }
  return n;
}

struct GridCounts {
  std::uint64_t quads = 0, cases = 0, covered = 0, ties = 0, wrong = 0, wrong_facing = 0, stray = 0;
};

GridCounts check_grid(unsigned threads) {
  constexpr int side = 5, points = side * side;
  GridCounts total;
  std::mutex mutex;
  parallel_for(points, threads, [&](std::size_t first) {
    Config config;
    DrawState state;
    state.width = state.height = state.scissor_x1 = state.scissor_y1 = 64;
    TileWalk walk(config, state);
    GridCounts n;
    const int unit = 1 << config.frac();
    // One pixel of margin on every side.
    const auto point = [&](int p) {
      return SnappedVertex{(1 + p % side) * unit, (1 + p / side) * unit, unit, {}, {}, {}};
    };
    for (int code = 0; code < points * points * points; ++code) {
      SnappedQuad q;
      q.vertex = {point(static_cast<int>(first)), point(code % points), point(code / points % points),
                  point(code / (points * points))};
      int count[side][side] = {}, front[side][side] = {};
      cover(q, config, state, walk, [&](int x, int y, bool is_front, bool tie) {
        n.ties += tie;
        if (x < 1 || y < 1 || x > side || y > side) {
          ++n.stray;
          return;
        }
        ++count[y - 1][x - 1];
        front[y - 1][x - 1] = is_front;
      });
      ++n.quads;
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
          const golden::ExactCoverage e = golden::exact_coverage(q, x + 1, y + 1);
          ++n.cases;
          n.covered += e.covered;
          n.wrong += count[y][x] != (e.covered ? 1 : 0);
          n.wrong_facing += e.covered && front[y][x] != (e.front ? 1 : 0);
        }
    }
    const std::lock_guard lock(mutex);
    total.quads += n.quads, total.cases += n.cases, total.covered += n.covered, total.ties += n.ties;
    total.wrong += n.wrong, total.wrong_facing += n.wrong_facing, total.stray += n.stray;
  });
  return total;
}

unsigned long long ull(std::uint64_t v) { return v; }

int run(int argc, char** argv) {
  const Options options(argc, argv, {{"samples", "10000000"}, {"seed", "1"}, {"threads", "0"}, {"grid", "1"}});
  const std::uint64_t wanted = options.number("samples"), seed = options.number("seed");
  const unsigned threads = options.threads();
  bool ok = true;

  std::printf("random meshes, seed %llu\n", ull(seed));
  Counts n;
  constexpr std::size_t batch = 24;
  for (std::uint64_t base = 0; n.samples < wanted; base += batch) {
    std::vector<Counts> parts(batch);
    parallel_for(batch, threads, [&](std::size_t i) { parts[i] = check_mesh(seed, base + i); });
    for (const Counts& p : parts) n += p;
  }
  std::printf("  %llu meshes, %llu quads (%llu triangles, %llu concave, %llu clockwise)\n", ull(n.meshes), ull(n.quads),
              ull(n.triangles), ull(n.concave), ull(n.clockwise));
  std::printf(
      "  %llu samples: %llu exact ties on edges, %llu on shared vertices; %llu pixels outside; %llu fragments flagged "
      "tie\n",
      ull(n.samples), ull(n.edge_ties), ull(n.vertices), ull(n.outside), ull(n.tie_flags));
  std::printf("  gaps %llu, doubles %llu, strays %llu\n", ull(n.gaps), ull(n.doubles), ull(n.strays));
  ok = ok && n.gaps == 0 && n.doubles == 0 && n.strays == 0;
  ok = ok && n.triangles > 0 && n.concave > 0 && n.clockwise > 0 && n.clockwise < n.quads;
  // Promised: 1 million ties and 100,000 shared vertices in 10 million samples.
  if (n.edge_ties * 10 < wanted || n.vertices * 100 < wanted) {
    std::printf("  too few ties or vertices\n");
    ok = false;
  }

  if (options.number("grid") != 0) {
    const GridCounts g = check_grid(threads);
    std::printf(
        "5x5 grid: %llu quads, %llu cases, %llu covered, %llu ties among them; wrong %llu, wrong facing %llu, strays "
        "%llu\n",
        ull(g.quads), ull(g.cases), ull(g.covered), ull(g.ties), ull(g.wrong), ull(g.wrong_facing), ull(g.stray));
    ok = ok && g.quads == 390'625 && g.wrong == 0 && g.wrong_facing == 0 && g.stray == 0 && g.covered > 0;
  }
  std::printf("%s\n", ok ? "passed" : "FAILED");
  return ok ? 0 : 1;
}

}  // namespace
}  // namespace quadrille::campaign

int main(int argc, char** argv) {
  return quadrille::campaign::guarded("coverage_campaign", quadrille::campaign::run, argc, argv);
}
