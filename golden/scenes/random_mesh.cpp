#include "golden/scenes/random_mesh.hpp"

#include "model/support/prng.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

namespace quadrille::golden {
namespace {

constexpr std::int64_t pixel = 256;

using Point = std::array<std::int64_t, 2>;
using Triangle = std::array<int, 3>;

std::int64_t orient(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

std::int64_t centre_below(std::int64_t x) { return ((x - 128) >> 8) * pixel + 128; }

/// 0: the diagonal 0-2 splits the quad into two triangles of positive or zero area, not both zero; 1: the diagonal 1-3
/// does; -1: neither, the quad is not a positively oriented simple one.
int valid_diagonal(const Point& a, const Point& b, const Point& c, const Point& d) {
  const auto both = [](std::int64_t s, std::int64_t t) { return s >= 0 && t >= 0 && s + t > 0; };
  if (both(orient(a, b, c), orient(a, c, d))) return 0;
  return both(orient(a, b, d), orient(b, c, d)) ? 1 : -1;
}

struct Grid {
  int columns, rows;
  std::vector<Point> points;

  int index(int i, int j) const { return j * (columns + 1) + i; }
  const Point& at(int i, int j) const { return points[static_cast<std::size_t>(index(i, j))]; }
  int diagonal(int i, int j) const { return valid_diagonal(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)); }
  bool cells_around_valid(int i, int j) const {
    for (int b = std::max(j - 1, 0); b <= std::min(j, rows - 1); ++b) {
      for (int a = std::max(i - 1, 0); a <= std::min(i, columns - 1); ++a) {
        if (diagonal(a, b) < 0) return false;
      }
    }
    return true;
  }
};

/// Both ends of one axis of the rectangle, at least `cells` pixels apart, inside the viewport.
std::array<std::int64_t, 2> pick_range(Prng& rng, int size, int cells, bool at_centres) {
  const std::int64_t slack = size - 1 - cells;  // whole pixels that are free to give away
  if (at_centres) {
    const std::int64_t lo = rng.integer(0, slack / 4);
    const std::int64_t hi = size - 1 - rng.integer(0, slack / 4);
    return {lo * pixel + 128, hi * pixel + 128};
  }
  return {rng.integer(0, slack * pixel / 4), size * pixel - rng.integer(0, slack * pixel / 4)};
}

/// Moves every vertex but the corners; those on a side stay on it.
void jitter_grid(Grid& grid, Prng& rng, const RandomMeshOptions& o, const RandomMesh& mesh) {
  const double step_x = static_cast<double>(mesh.x1 - mesh.x0) / o.columns;
  const double step_y = static_cast<double>(mesh.y1 - mesh.y0) / o.rows;
  const std::vector<Point> home = grid.points;
  std::vector<bool> tie(home.size());
  for (std::size_t v = 0; v < tie.size(); ++v) tie[v] = rng.chance(o.tie_share);
  for (int pass = 0; pass < 4; ++pass) {
    for (int j = 0; j <= o.rows; ++j) {
      for (int i = 0; i <= o.columns; ++i) {
        const bool side_x = i == 0 || i == o.columns, side_y = j == 0 || j == o.rows;
        if (side_x && side_y) continue;
        const std::size_t v = static_cast<std::size_t>(grid.index(i, j));
        const Point old = grid.points[v];
        Point moved = home[v];
        const double dx = rng.uniform(-o.jitter, o.jitter) * step_x, dy = rng.uniform(-o.jitter, o.jitter) * step_y;
        if (!side_x) {
          moved[0] += static_cast<std::int64_t>(std::floor(dx));
          if (tie[v]) moved[0] = centre_below(moved[0]);
          moved[0] = std::clamp(moved[0], mesh.x0, mesh.x1);
        }
        if (!side_y) {
          moved[1] += static_cast<std::int64_t>(std::floor(dy));
          if (tie[v]) moved[1] = centre_below(moved[1]);
          moved[1] = std::clamp(moved[1], mesh.y0, mesh.y1);
        }
        grid.points[v] = moved;
        if (!grid.cells_around_valid(i, j)) grid.points[v] = old;
      }
    }
  }
}

std::vector<Triangle> triangulate(const Grid& grid, Prng& rng) {
  std::vector<Triangle> triangles;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const std::array<int, 4> c{grid.index(i, j), grid.index(i + 1, j), grid.index(i + 1, j + 1),
                                 grid.index(i, j + 1)};
      int diagonal = grid.diagonal(i, j);
      if (diagonal == 0 && rng.chance(0.5)) {  // a convex cell may be cut either way
        const int other = valid_diagonal(grid.at(i + 1, j), grid.at(i + 1, j + 1), grid.at(i, j + 1), grid.at(i, j));
        if (other == 0) diagonal = 1;
      }
      if (diagonal == 0) {
        triangles.push_back({c[0], c[1], c[2]});
        triangles.push_back({c[0], c[2], c[3]});
      } else {
        triangles.push_back({c[0], c[1], c[3]});
        triangles.push_back({c[1], c[2], c[3]});
      }
    }
  }
  return triangles;
}

/// Joins neighbours in random order; what finds no partner stays a triangle with a repeated corner.
std::vector<std::array<int, 4>> join_pairs(const std::vector<Triangle>& triangles, Prng& rng, double triangle_share) {
  std::map<std::pair<int, int>, std::size_t> side;  // directed edge → triangle · 3 + index of its first corner
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) side[{triangles[t][k], triangles[t][(k + 1) % 3]}] = t * 3 + k;
  }
  std::vector<std::size_t> order(triangles.size());
  std::vector<bool> used(triangles.size());
  for (std::size_t t = 0; t < order.size(); ++t) order[t] = t;
  rng.shuffle(order);
  std::vector<std::array<int, 4>> cells;
  for (const std::size_t t : order) {
    if (used[t]) continue;
    used[t] = true;
    const Triangle& own = triangles[t];
    bool joined = false;
    if (!rng.chance(triangle_share)) {
      const std::size_t first = static_cast<std::size_t>(rng.below(3));
      for (std::size_t k = 0; k < 3 && !joined; ++k) {
        const std::size_t e = (first + k) % 3;
        const int a = own[e], b = own[(e + 1) % 3];
        const auto found = side.find({b, a});
        if (found == side.end() || used[found->second / 3]) continue;
        const std::size_t other = found->second / 3;
        used[other] = true;
        cells.push_back({a, triangles[other][(found->second % 3 + 2) % 3], b, own[(e + 2) % 3]});
        joined = true;
      }
    }
    if (!joined) {
      const std::size_t twice = static_cast<std::size_t>(rng.below(3));
      cells.push_back({own[twice], own[twice], own[(twice + 1) % 3], own[(twice + 2) % 3]});
    }
  }
  return cells;
}

}  // namespace

RandomMesh make_random_mesh(std::uint64_t seed, const RandomMeshOptions& o) {
  const auto share = [](double s) { return s >= 0 && s <= 1; };
  if (o.columns < 1 || o.rows < 1 || o.width < o.columns + 2 || o.height < o.rows + 2 || o.width > 32768 ||
      o.height > 32768) {
    throw std::invalid_argument("random mesh: " + std::to_string(o.columns) + "x" + std::to_string(o.rows) +
                                " cells do not fit a viewport of " + std::to_string(o.width) + "x" +
                                std::to_string(o.height));
  }
  if (!share(o.tie_share) || !share(o.triangle_share) || !(o.jitter >= 0 && o.jitter <= 4)) {
    throw std::invalid_argument("random mesh: shares lie between 0 and 1, jitter between 0 and 4");
  }
  Prng rng(seed);
  RandomMesh mesh;
  const bool ties = o.tie_share > 0;
  const auto xs = pick_range(rng, o.width, o.columns, ties), ys = pick_range(rng, o.height, o.rows, ties);
  mesh.x0 = xs[0], mesh.x1 = xs[1], mesh.y0 = ys[0], mesh.y1 = ys[1];

  Grid grid{o.columns, o.rows, {}};
  for (int j = 0; j <= o.rows; ++j) {
    for (int i = 0; i <= o.columns; ++i) {
      Point p{mesh.x0 + (mesh.x1 - mesh.x0) * i / o.columns, mesh.y0 + (mesh.y1 - mesh.y0) * j / o.rows};
      if (ties) p = {centre_below(p[0]), centre_below(p[1])};
      grid.points.push_back(p);
    }
  }
  jitter_grid(grid, rng, o, mesh);
  mesh.vertices = grid.points;
  mesh.cells = join_pairs(triangulate(grid, rng), rng, o.triangle_share);

  std::vector<double> w(mesh.vertices.size(), 1.0), z(mesh.vertices.size());
  for (std::size_t v = 0; v < w.size(); ++v) {
    if (o.vary_w) w[v] = std::ldexp(1.0, static_cast<int>(rng.integer(-1, 2)));
    z[v] = rng.uniform(0.1, 0.9);
  }
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    std::array<int, 4>& cell = mesh.cells[c];
    const auto point = [&](std::size_t i) -> const Point& {
      return mesh.vertices[static_cast<std::size_t>(cell[i & 3])];
    };
    bool triangle = false, reflex = false;
    for (std::size_t i = 0; i < 4; ++i) {
      triangle = triangle || cell[i] == cell[(i + 1) & 3];
      reflex = reflex || orient(point(i), point(i + 1), point(i + 2)) < 0;
    }
    mesh.triangles += triangle ? 1 : 0;
    mesh.concave += reflex ? 1 : 0;
    std::rotate(cell.begin(), cell.begin() + static_cast<std::ptrdiff_t>(rng.below(4)), cell.end());
    if (rng.chance(0.5)) {
      std::reverse(cell.begin(), cell.end());
    } else {
      ++mesh.clockwise;  // positive orientation with y down
    }
    WindowQuad quad;
    quad.id = static_cast<std::uint32_t>(c);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t v = static_cast<std::size_t>(cell[i]);
      const double x = static_cast<double>(mesh.vertices[v][0]) / pixel,
                   y = static_cast<double>(mesh.vertices[v][1]) / pixel;
      quad.vertex[i] = {x * w[v], y * w[v], z[v] * w[v], w[v]};
      quad.attribute[i].assign(4, 0.0);
      quad.attribute[i][i] = 1;
    }
    mesh.quads.push_back(std::move(quad));
  }
  return mesh;
}

}  // namespace quadrille::golden
