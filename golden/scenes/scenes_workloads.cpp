// Scenes that no paper has: loads for the machine, each with something that can be skipped, or with nothing of the
// kind.
#include "golden/scenes/plane_pair.hpp"
#include "golden/scenes/scene_builders.hpp"
#include "model/support/prng.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace quadrille::golden {
namespace {

constexpr std::uint64_t seed = 1;  ///< of everything random here; the titles name it

Scene lit() {
  Scene scene;
  scene.shade = "normal";
  return scene;
}

/// The plane z of a 512 × 512 picture in pixels, y down; at other sizes all of it scales. z is window z.
Scene plane_scene() {
  Scene scene;
  scene.perspective = false;
  scene.camera.matrix = Matrix4{1.0 / 256, 0, 0, -1, 0, -1.0 / 256, 0, 1, 0, 0, 2, -1, 0, 0, 0, 1};
  return scene;
}

struct Rectangle {
  double x0, y0, x1, y1;
};

/// A rectangle of a plane scene, turned about its centre by (cosine, sine), that shows a rectangle of the texture.
void add_rectangle(Mesh& mesh, const Rectangle& place, double z, const Rectangle& texture, const Vec2& turn = {1, 0}) {
  const double cx = (place.x0 + place.x1) / 2, cy = (place.y0 + place.y1) / 2;
  const auto corner = [&](double x, double y) {
    return Vec3{cx + turn[0] * (x - cx) - turn[1] * (y - cy), cy + turn[1] * (x - cx) + turn[0] * (y - cy), z};
  };
  // Counter-clockwise on the screen, from the lower left corner on: the texture's v is up.
  add_quad(
      mesh,
      {corner(place.x0, place.y1), corner(place.x1, place.y1), corner(place.x1, place.y0), corner(place.x0, place.y0)},
      {{{texture.x0, texture.y0}, {texture.x1, texture.y0}, {texture.x1, texture.y1}, {texture.x0, texture.y1}}});
}

// ---- A city ---------------------------------------------------------------------------------------------------------

struct Box {
  Vec3 low, high;
};

Vec3 centre(const Box& box) {
  return {(box.low[0] + box.high[0]) / 2, (box.low[1] + box.high[1]) / 2, (box.low[2] + box.high[2]) / 2};
}

using BoxFace = std::array<Vec3, 4>;

/// The sides of a box, counter-clockwise as seen from outside: −x, +x, −z, +z, the top, the bottom.
std::array<BoxFace, 6> faces_of(const Box& box) {
  const auto& [a, b] = box;
  return {{{{{a[0], a[1], a[2]}, {a[0], a[1], b[2]}, {a[0], b[1], b[2]}, {a[0], b[1], a[2]}}},
           {{{b[0], a[1], b[2]}, {b[0], a[1], a[2]}, {b[0], b[1], a[2]}, {b[0], b[1], b[2]}}},
           {{{b[0], a[1], a[2]}, {a[0], a[1], a[2]}, {a[0], b[1], a[2]}, {b[0], b[1], a[2]}}},
           {{{a[0], a[1], b[2]}, {b[0], a[1], b[2]}, {b[0], b[1], b[2]}, {a[0], b[1], b[2]}}},
           {{{a[0], b[1], b[2]}, {b[0], b[1], b[2]}, {b[0], b[1], a[2]}, {a[0], b[1], a[2]}}},
           {{{a[0], a[1], a[2]}, {b[0], a[1], a[2]}, {b[0], a[1], b[2]}, {a[0], a[1], b[2]}}}}};
}

double distance2(const Vec3& a, const Vec3& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

Vec3 centre(const BoxFace& face) {
  Vec3 sum{};
  for (const Vec3& corner : face)
    for (std::size_t i = 0; i < 3; ++i) sum[i] += corner[i] / 4;
  return sum;
}

enum class Order { front_to_back, back_to_front, random };

/// 10 × 10 boxes with streets between, on a ground of one quad, seen along the streets from above the lower roofs.
Scene city(Order order) {
  constexpr int blocks = 10;
  constexpr std::size_t sides = 5;  // no bottom
  Scene scene = lit();
  scene.camera = look_from({21.2, 3.4, 22.5}, {11, 0.2, 10}, 50);
  Prng random(seed);
  std::vector<Box> boxes;
  for (int j = 0; j < blocks; ++j) {
    for (int i = 0; i < blocks; ++i) {
      const double x = 2 * i, z = 2 * j, height = random.uniform(0.6, 3.4), half = random.uniform(0.5, 0.75);
      boxes.push_back({{x - half, 0, z - half}, {x + half, height, z + half}});
    }
  }
  const auto nearer = [&scene](const auto& a, const auto& b) {
    return distance2(centre(a), scene.camera.eye) < distance2(centre(b), scene.camera.eye);
  };
  std::ranges::stable_sort(boxes, nearer);
  std::vector<BoxFace> faces;
  for (const Box& box : boxes) {
    std::array<BoxFace, 6> all = faces_of(box);
    std::stable_sort(all.begin(), all.begin() + sides, nearer);
    faces.insert(faces.end(), all.begin(), all.begin() + sides);
  }
  faces.push_back({{{-2, 0, 20}, {20, 0, 20}, {20, 0, -2}, {-2, 0, -2}}});
  if (order == Order::back_to_front) std::ranges::reverse(faces);
  if (order == Order::random) random.shuffle(faces);
  for (const BoxFace& face : faces) add_quad(scene.mesh, face);
  return scene;
}

Scene city_front() { return city(Order::front_to_back); }
Scene city_back() { return city(Order::back_to_front); }
Scene city_random() { return city(Order::random); }

// ---- Pictures in a plane --------------------------------------------------------------------------------------------

/// A map of 8 × 8 tiles, 96 sprites of 32 × 32 pixels on it, eight lines of text over all; painted in this order.
/// `turned`: sprites and letters turned by angles of right triangles, about points of the pixel grid.
Scene sprite_scene(bool turned) {
  static constexpr std::array<Vec2, 4> turns{
      {{3.0 / 5, 4.0 / 5}, {12.0 / 13, 5.0 / 13}, {15.0 / 17, -8.0 / 17}, {24.0 / 25, -7.0 / 25}}};
  constexpr int sprites = 96, lines = 8, letters = 48;
  Scene scene = plane_scene();
  Prng random(seed);
  const auto cell = [&random](int cells) {
    const double size = 1.0 / cells, x = static_cast<double>(random.integer(0, cells - 1)) * size,
                 y = static_cast<double>(random.integer(0, cells - 1)) * size;
    return Rectangle{x, y, x + size, y + size};
  };
  for (int j = 0; j < 8; ++j)
    for (int i = 0; i < 8; ++i)
      add_rectangle(scene.mesh, {64.0 * i, 64.0 * j, 64.0 * (i + 1), 64.0 * (j + 1)}, 0.9375, cell(4));
  for (int n = 0; n < sprites; ++n) {
    const auto x = static_cast<double>(random.integer(8, 472)), y = static_cast<double>(random.integer(8, 472));
    const Rectangle texture = cell(8);
    const Vec2 turn = turned ? turns[static_cast<std::size_t>(random.integer(0, 3))] : Vec2{1, 0};
    add_rectangle(scene.mesh, {x, y, x + 32, y + 32}, 0.875 - n / 128.0, texture, turn);
  }
  for (int line = 0; line < lines; ++line) {
    for (int letter = 0; letter < letters; ++letter) {
      const double x = 24 + 9 * letter, y = 340 + 18 * line;
      if (random.chance(0.15)) continue;  // between words
      add_rectangle(scene.mesh, {x, y, x + 8, y + 12}, 0.0625, cell(16), turned ? turns[3] : Vec2{1, 0});
    }
  }
  return scene;
}

Scene sprites() { return sprite_scene(false); }
Scene sprites_turned() { return sprite_scene(true); }

/// Eight quads over the whole picture, the nearest first.
Scene layers_large() {
  Scene scene = plane_scene();
  for (int n = 0; n < 8; ++n)
    add_rectangle(scene.mesh, {0, 0, 512, 512}, (n + 1) / 16.0, {0, 0, (n + 1) / 2.0, (n + 1) / 2.0});
  return scene;
}

/// Eight layers of 14 × 14 quads of 32 × 32 pixels, each layer elsewhere; no edge on one of a tile.
Scene layers_of_tiles(Order order) {
  constexpr int across = 14;
  Scene scene = plane_scene();
  struct Place {
    int layer, i, j;
  };
  std::vector<Place> places;
  for (int layer = 0; layer < 8; ++layer)
    for (int j = 0; j < across; ++j)
      for (int i = 0; i < across; ++i) places.push_back({layer, i, j});
  if (order == Order::back_to_front) std::ranges::reverse(places);
  Prng random(seed);
  if (order == Order::random) random.shuffle(places);
  for (const auto& [layer, i, j] : places) {
    const double x = 11.25 + 5.5 * layer + 32 * i, y = 52.75 - 5.5 * layer + 32 * j;
    add_rectangle(scene.mesh, {x, y, x + 32, y + 32}, (layer + 1) / 16.0,
                  {i / 14.0, j / 14.0, (i + 1) / 14.0, (j + 1) / 14.0});
  }
  return scene;
}

Scene layers_small() { return layers_of_tiles(Order::front_to_back); }
Scene layers_small_back() { return layers_of_tiles(Order::back_to_front); }
Scene layers_small_random() { return layers_of_tiles(Order::random); }

// ---- Meshes ---------------------------------------------------------------------------------------------------------

/// A wavy square of 96 × 96 quads, seen from so far that a quad of 512 × 512 pixels is half a pixel wide.
Scene subpixel_mesh() {
  constexpr int quads = 96;
  Scene scene = lit();
  const auto height = [](double x, double y) { return 0.3 * x * y * (1 - x * x) * (3 - y * y); };
  for (int j = 0; j <= quads; ++j) {
    for (int i = 0; i <= quads; ++i) {
      const double u = static_cast<double>(i) / quads, v = static_cast<double>(j) / quads;
      const double x = 2 * u - 1, z = 2 * v - 1;
      scene.mesh.positions.push_back({x, height(x, z), z});
      scene.mesh.texcoords.push_back({u, v});
    }
  }
  for (int j = 0; j < quads; ++j) {
    for (int i = 0; i < quads; ++i) {
      Face face;
      for (const auto& [di, dj] : {std::array{0, 1}, std::array{1, 1}, std::array{1, 0}, std::array{0, 0}}) {
        const int k = (j + dj) * (quads + 1) + i + di;
        face.push_back({k, k, -1});
      }
      scene.mesh.faces.push_back(std::move(face));
    }
  }
  scene.camera = look_from({7, 11, 10}, {0, 0, 0}, 60);
  return scene;
}

/// A torus, closed and without a pole, its quads counter-clockwise as seen from outside.
Scene closed_mesh() {
  constexpr int around = 48, across = 24;
  constexpr double radius = 1, tube = 0.45;
  Scene scene = lit();
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * j / across;
      const Vec3 normal{std::sin(a) * std::cos(b), std::sin(b), std::cos(a) * std::cos(b)};
      scene.mesh.normals.push_back(normal);
      scene.mesh.positions.push_back(
          {radius * std::sin(a) + tube * normal[0], tube * normal[1], radius * std::cos(a) + tube * normal[2]});
    }
  }
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      Face face;
      for (const auto& [di, dj] : {std::array{0, 0}, std::array{1, 0}, std::array{1, 1}, std::array{0, 1}}) {
        const int k = (i + di) % around * across + (j + dj) % across;
        face.push_back({k, -1, k});
      }
      scene.mesh.faces.push_back(std::move(face));
    }
  }
  scene.camera = look_from({0.8, 2.6, 3.0}, {0, 0, 0}, 42);
  scene.cull = Cull::back;
  return scene;
}

/// The inside of a room with two pillars and a table, the eye in its middle: quads before, beside and behind it.
Scene room() {
  Scene scene = lit();
  const Box walls{{-4, 0, -4}, {4, 3, 4}};
  constexpr int parts = 4;
  for (const BoxFace& wall : faces_of(walls)) {
    const auto point = [&wall](int i, int j) {
      Vec3 p{};
      const double u = static_cast<double>(i) / parts, v = static_cast<double>(j) / parts;
      for (std::size_t c = 0; c < 3; ++c)
        p[c] = (1 - v) * ((1 - u) * wall[0][c] + u * wall[1][c]) + v * ((1 - u) * wall[3][c] + u * wall[2][c]);
      return p;
    };
    for (int j = 0; j < parts; ++j)  // seen from inside
      for (int i = 0; i < parts; ++i)
        add_quad(scene.mesh, {point(i + 1, j), point(i, j), point(i, j + 1), point(i + 1, j + 1)});
  }
  for (const Box& box : {Box{{-2.3, 0, -2.6}, {-1.8, 3, -2.1}}, Box{{1.2, 0, -0.2}, {1.7, 3, 0.6}},
                         Box{{-1, 0.7, -2.2}, {0.9, 0.8, -1.2}}, Box{{0.3, 0, 1.5}, {1.4, 1.2, 2.4}}}) {
    for (const BoxFace& face : faces_of(box)) add_quad(scene.mesh, face);
  }
  scene.camera = look_from({0.2, 1.5, 0.4}, {-0.4, 1.2, -3}, 75);
  scene.camera.near = 0.125;
  return scene;
}

constexpr std::string_view no_paper = "workload";

constexpr std::array<SceneEntry, 13> entries{{
    {"city_front", "A city of 100 boxes, front to back (seed 1)", no_paper, city_front},
    {"city_back", "The same city back to front", no_paper, city_back},
    {"city_random", "The same city in random order (seed 1)", no_paper, city_random},
    {"sprites", "2-D: a map, sprites and lines of text, all axis-aligned (seed 1)", no_paper, sprites},
    {"sprites_turned", "The same with sprites and letters turned", no_paper, sprites_turned},
    {"subpixel_mesh", "A mesh of 96 × 96 quads half a pixel wide", no_paper, subpixel_mesh},
    {"closed_mesh", "A torus of 48 × 24 quads with back faces culled", no_paper, closed_mesh},
    {"room", "A room with the eye among the quads", no_paper, room},
    {"layers_large", "Eight quads over the whole picture, front to back", no_paper, layers_large},
    {"layers_small", "Eight layers of unaligned quads of 32 × 32 pixels, front to back", no_paper, layers_small},
    {"layers_small_back", "The same back to front", no_paper, layers_small_back},
    {"layers_small_random", "The same in random order (seed 1)", no_paper, layers_small_random},
    {"planes", "Eight pairs of parallel planes at distance 50, 1 to 0.005 apart, the nearer one over the other",
     no_paper, plane_strips},
}};

}  // namespace

std::span<const SceneEntry> workload_scenes() { return entries; }

}  // namespace quadrille::golden
