#include "tb/studies/compare/creases.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace quadrille::compare {
namespace {

using golden::Vec2;
using golden::Vec3;
using golden::methods::Quad;

void check_quads(const AttributeImage& image, std::span<const Quad> quads) {
  for (const std::uint32_t q : image.quad)
    if (q != AttributeImage::no_quad && q >= quads.size())
      throw std::invalid_argument("the frame shows a quad that the draw does not have");
}

Vec3 window_position(const WindowVertex& v) { return {v.x / v.w, v.y / v.w, v.z / v.w}; }
Vec2 in_plane(const Vec3& v) { return {v[0], v[1]}; }

/// An edge of one quad with its ends in order of their positions, so that both quads' records of an edge are equal.
struct QuadEdge {
  std::array<Vec3, 2> end;
  std::uint32_t quad;
  std::size_t edge;                   ///< of the quad, 0 … 3
  std::array<std::size_t, 2> corner;  ///< of the quad, at either end

  std::pair<std::uint32_t, std::size_t> place() const { return {quad, edge}; }
};

std::vector<QuadEdge> visible_edges(std::span<const Quad> quads) {
  std::vector<QuadEdge> edges;
  edges.reserve(4 * quads.size());
  for (std::size_t q = 0; q < quads.size(); ++q) {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t j = (i + 1) % 4;
      const WindowVertex &a = quads[q].vertex[i], &b = quads[q].vertex[j];
      if (!(a.w > 0 && b.w > 0)) continue;
      QuadEdge edge{{window_position(a), window_position(b)}, static_cast<std::uint32_t>(q), i, {i, j}};
      const auto finite = [](const Vec3& v) {
        return std::ranges::all_of(v, [](double c) { return std::isfinite(c); });
      };
      if (!finite(edge.end[0]) || !finite(edge.end[1]) || in_plane(edge.end[0]) == in_plane(edge.end[1])) continue;
      if (edge.end[1] < edge.end[0]) std::swap(edge.end[0], edge.end[1]), std::swap(edge.corner[0], edge.corner[1]);
      edges.push_back(edge);
    }
  }
  return edges;
}

bool equal_attributes(std::span<const Quad> quads, const QuadEdge& a, const QuadEdge& b) {
  for (std::size_t i = 0; i < 2; ++i)
    if (quads[a.quad].attribute[a.corner[i]] != quads[b.quad].attribute[b.corner[i]]) return false;
  return true;
}

/// Whether the line through a and b, wherever they are in homogeneous coordinates, passes between the outer pixel
/// centres of the profile, or through one.
bool crosses(const Profile& profile, const WindowVertex& a, const WindowVertex& b) {
  const auto side = [&](int offset) {
    const double x = profile.x + (profile.axis == Axis::x ? offset : 0) + 0.5;
    const double y = profile.y + (profile.axis == Axis::y ? offset : 0) + 0.5;
    return (b.x - x * b.w) * (a.y - y * a.w) - (b.y - y * b.w) * (a.x - x * a.w);
  };
  const double near_end = side(-fit_pixels), far_end = side(fit_pixels - 1);
  return !((near_end > 0 && far_end > 0) || (near_end < 0 && far_end < 0));
}

LineJump measure_diagonal(const AttributeImage& image, const Quad& quad, std::uint32_t index, std::size_t corner) {
  const auto vertex = [&](std::size_t i) -> const WindowVertex& { return quad.vertex[i % 4]; };
  const auto end = [&](std::size_t i) { return in_plane(window_position(vertex(i))); };
  std::vector<Profile> profiles = line_profiles(image, end(corner), end(corner + 2));
  std::erase_if(profiles, [&](const Profile& p) { return crosses(p, vertex(corner + 1), vertex(corner + 3)); });
  return measure_profiles(image, profiles, {index, index});
}

void check_set(const DiagonalSet& set, std::size_t quads) {
  if (set[0].size() != quads || set[1].size() != quads)
    throw std::invalid_argument("a set of diagonals is of another number of quads");
}

void add_diagonal(const LineJump& jump, std::uint32_t index, DiagonalCreases& total) {
  if (jump.profiles() > 0) {
    ++total.quads;
    if (total.worst == AttributeImage::no_quad || jump.line_slope.max() > total.jump.line_slope.max())
      total.worst = index;
  }
  total.jump.merge(jump);
}

/// On the screen and in front of the eye; triangles are.
bool is_convex(const Quad& quad) {
  if (!std::ranges::all_of(quad.vertex, [](const WindowVertex& v) { return v.w > 0; })) return false;
  const auto corner = [&](std::size_t i) { return in_plane(window_position(quad.vertex[i % 4])); };
  bool left = false, right = false;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 a = corner(i), b = corner(i + 1), c = corner(i + 2);
    const double turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
    left = left || turn > 0;
    right = right || turn < 0;
  }
  return !(left && right);
}

/// Whether a diagonal of the quad crosses the profile of its edge. A triangle's diagonals are edges of it: one that is
/// this edge does not count.
bool diagonal_crosses(const Profile& profile, const Quad& quad, const std::array<Vec2, 2>& edge) {
  for (const std::size_t i : {0, 1}) {
    const WindowVertex &a = quad.vertex[i], &b = quad.vertex[i + 2];
    const Vec2 from = in_plane(window_position(a)), to = in_plane(window_position(b));
    const bool is_edge = (from == edge[0] && to == edge[1]) || (from == edge[1] && to == edge[0]);
    if (!is_edge && crosses(profile, a, b)) return true;
  }
  return false;
}

/// Appends the pixels of the profile that lie within 1 of the edge and show neither of its quads.
void find_holes(const AttributeImage& image, const Profile& profile, const std::array<std::uint32_t, 2>& quads,
                std::vector<std::size_t>& holes) {
  const bool along_x = profile.axis == Axis::x;
  const int position = along_x ? profile.x : profile.y, size = along_x ? image.width : image.height;
  if (position < fit_pixels || position > size - fit_pixels) return;
  const auto at = [&](int offset) {
    return along_x ? image.pixel(profile.x + offset, profile.y) : image.pixel(profile.x, profile.y + offset);
  };
  const std::uint32_t near_quad = image.quad[at(-fit_pixels)], far_quad = image.quad[at(fit_pixels - 1)];
  if (!(near_quad == quads[0] && far_quad == quads[1]) && !(near_quad == quads[1] && far_quad == quads[0])) return;
  for (const int offset : {-1, 0, 1}) {
    const std::uint32_t shown = image.quad[at(offset)];
    if (std::fabs(profile.distance + offset) <= 1 && shown != quads[0] && shown != quads[1])
      holes.push_back(at(offset));
  }
}

}  // namespace

std::vector<QuadCreases> measure_quad_diagonals(const AttributeImage& image, std::span<const Quad> quads) {
  check_quads(image, quads);
  std::vector<QuadCreases> creases(quads.size());
  for (std::size_t q = 0; q < quads.size(); ++q) {
    if (!std::ranges::all_of(quads[q].vertex, [](const WindowVertex& v) { return v.w > 0; })) continue;
    creases[q].d02 = measure_diagonal(image, quads[q], static_cast<std::uint32_t>(q), 0);
    creases[q].d13 = measure_diagonal(image, quads[q], static_cast<std::uint32_t>(q), 1);
  }
  return creases;
}

DiagonalSet measured_diagonals(std::span<const QuadCreases> creases) {
  DiagonalSet set;
  for (const QuadCreases& quad : creases) {
    set[0].push_back(quad.d02.profiles() > 0);
    set[1].push_back(quad.d13.profiles() > 0);
  }
  return set;
}

DiagonalSet in_both(const DiagonalSet& a, const DiagonalSet& b) {
  check_set(a, b[0].size());
  check_set(b, b[0].size());
  DiagonalSet set = a;
  for (std::size_t d = 0; d < set.size(); ++d)
    for (std::size_t q = 0; q < set[d].size(); ++q) set[d][q] = a[d][q] && b[d][q];
  return set;
}

Diagonals combine_diagonals(std::span<const QuadCreases> creases, const DiagonalSet& use) {
  check_set(use, creases.size());
  Diagonals result;
  for (std::size_t q = 0; q < creases.size(); ++q) {
    if (use[0][q]) add_diagonal(creases[q].d02, static_cast<std::uint32_t>(q), result.d02);
    if (use[1][q]) add_diagonal(creases[q].d13, static_cast<std::uint32_t>(q), result.d13);
  }
  return result;
}

Diagonals measure_diagonals(const AttributeImage& image, std::span<const Quad> quads) {
  const std::vector<bool> all(quads.size(), true);
  return combine_diagonals(measure_quad_diagonals(image, quads), {all, all});
}

InnerJumps measure_inside(const AttributeImage& image) {
  InnerJumps result;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::uint32_t quad = image.quad[image.pixel(x, y)];
      if (quad == AttributeImage::no_quad) continue;
      for (const Axis axis : {Axis::x, Axis::y}) {
        const Profile profile{axis, x, y, 0.5};
        ProfileJump jump;
        const ProfileState state = measure_profile(image, profile, {quad, quad}, jump);
        if (state == ProfileState::undefined) ++result.undefined;
        if (state != ProfileState::measured) continue;
        if (result.line_slope.count() == 0 || jump.line.slope > result.line_slope.max())
          result.worst = profile, result.worst_quad = quad;
        result.line_slope.add(jump.line.slope);
        result.parabola_slope.add(jump.parabola.slope);
      }
    }
  }
  return result;
}

std::vector<SharedEdge> shared_edges(std::span<const Quad> quads) {
  std::vector<QuadEdge> edges = visible_edges(quads);
  std::ranges::sort(edges, [](const QuadEdge& a, const QuadEdge& b) {
    if (a.end != b.end) return a.end < b.end;
    return a.place() < b.place();
  });
  std::vector<std::pair<QuadEdge, QuadEdge>> pairs;
  for (auto first = edges.begin(); first != edges.end();) {
    const auto last = std::find_if(first, edges.end(), [&](const QuadEdge& e) { return e.end != first->end; });
    if (last - first == 2 && first[0].quad != first[1].quad && equal_attributes(quads, first[0], first[1]))
      pairs.emplace_back(first[0], first[1]);
    first = last;
  }
  std::ranges::sort(pairs, {}, [](const auto& pair) { return pair.first.place(); });
  std::vector<SharedEdge> shared;
  for (const auto& [a, b] : pairs) shared.push_back({{a.quad, b.quad}, {in_plane(a.end[0]), in_plane(a.end[1])}});
  return shared;
}

Gaps measure_gaps(const AttributeImage& image, std::span<const Quad> quads) {
  check_quads(image, quads);
  Gaps result;
  std::vector<std::size_t> holes;
  for (const SharedEdge& edge : shared_edges(quads)) {
    ++result.edges;
    std::vector<Profile> profiles = line_profiles(image, edge.window[0], edge.window[1]);
    for (const Profile& profile : profiles) find_holes(image, profile, edge.quad, holes);
    std::erase_if(profiles, [&](const Profile& p) {
      return std::ranges::any_of(
          edge.quad, [&](std::uint32_t q) { return diagonal_crosses(settle_tie(image, p), quads[q], edge.window); });
    });
    const LineJump jump = measure_profiles(image, profiles, edge.quad);
    if (!std::ranges::all_of(edge.quad, [&](std::uint32_t q) { return is_convex(quads[q]); })) {
      result.concave.merge(jump);
      continue;
    }
    if (jump.profiles() > 0) {
      ++result.measured;
      if (result.measured == 1 || jump.gap.max() > result.jump.gap.max()) result.worst = edge.quad;
    }
    result.jump.merge(jump);
  }
  // Profiles of two edges may meet in a pixel.
  std::ranges::sort(holes);
  holes.erase(std::unique(holes.begin(), holes.end()), holes.end());
  for (const std::size_t p : holes) ++(image.covered(p) ? result.foreign : result.empty);
  return result;
}

}  // namespace quadrille::compare
