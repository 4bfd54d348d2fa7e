#include "model/page/drawing.hpp"

#include "golden/io/texture.hpp"
#include "golden/scenes/shading.hpp"
#include "model/port/draw_state.hpp"
#include "model/port/snap.hpp"
#include "tb/passes/pass.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

namespace quadrille::page {
namespace {

using golden::AttributeSet;
using golden::Matrix4;
using golden::Vec3;

Vec3 row(const Matrix4& m, std::size_t i) { return {m[4 * i], m[4 * i + 1], m[4 * i + 2]}; }
double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The middle of the box around the mesh as the scene has it: what it turns about.
Vec3 middle(const golden::Mesh& mesh) {
  Vec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  for (const Vec3& p : mesh.positions)
    for (std::size_t i = 0; i < 3; ++i) low[i] = std::min(low[i], p[i]), high[i] = std::max(high[i], p[i]);
  return {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2};
}

/// p turned about an axis of unit length.
Vec3 turned(const Vec3& p, const Vec3& axis, double degrees) {
  const double angle = degrees * 3.14159265358979323846 / 180, c = std::cos(angle), s = std::sin(angle);
  const Vec3 side = cross(axis, p);
  const double along = dot(axis, p) * (1 - c);
  return {p[0] * c + side[0] * s + axis[0] * along, p[1] * c + side[1] * s + axis[1] * along,
          p[2] * c + side[2] * s + axis[2] * along};
}

/// The matrix of a mesh that is turned about its middle and moved towards the eye first.
Matrix4 moved(const Matrix4& m, const Vec3& centre, const Request& request) {
  const Vec3 right = golden::unit_vector(row(m, 0));
  const Vec3 across = row(m, 1);
  const double along = dot(across, right);
  const Vec3 up =
      golden::unit_vector({across[0] - along * right[0], across[1] - along * right[1], across[2] - along * right[2]});
  const auto turn = [&](const Vec3& p) { return turned(turned(p, up, request.yaw), right, request.pitch); };
  Vec3 toward{};
  const Vec3 depth = row(m, 3);
  if (const double length2 = dot(depth, depth); length2 > 0) {
    const double distance = (dot(depth, centre) + m[15]) / length2 * request.dolly;
    toward = {-depth[0] * distance, -depth[1] * distance, -depth[2] * distance};
  }
  // Columns: what becomes of the axes and of the origin.
  const Vec3 x = turn({1, 0, 0}), y = turn({0, 1, 0}), z = turn({0, 0, 1}), origin = turn(centre);
  Matrix4 out;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 r = row(m, i);
    out[4 * i] = dot(r, x);
    out[4 * i + 1] = dot(r, y);
    out[4 * i + 2] = dot(r, z);
    out[4 * i + 3] = m[4 * i + 3] + dot(r, {centre[0] - origin[0] + toward[0], centre[1] - origin[1] + toward[1],
                                            centre[2] - origin[2] + toward[2]});
  }
  return out;
}

std::shared_ptr<const golden::Texture> own_picture;

std::function<Vec3(double, double)> texture_of(const std::string& name) {
  for (const auto kind : {golden::TextureKind::checker, golden::TextureKind::fine, golden::TextureKind::globe})
    if (golden::texture_name(kind) == name)
      return [kind](double u, double v) { return golden::procedural_texture(kind, u, v); };
  if (name == "grid")
    return [](double u, double v) {
      const auto from_line = [](double c) { return std::fabs(8 * c - std::round(8 * c)); };
      return std::min(from_line(u), from_line(v)) < 0.06 ? Vec3{0.10, 0.14, 0.30} : Vec3{0.92, 0.92, 0.88};
    };
  if (name == "own" && own_picture)
    return [picture = own_picture](double u, double v) {
      const std::array<double, 4> rgba = picture->sample(u, v);
      return Vec3{rgba[0], rgba[1], rgba[2]};
    };
  throw std::invalid_argument("texture=" + name + ": expected checker, fine, grid, globe" +
                              (name == "own" ? "; or choose a picture of your own again" : ""));
}

WindowQuad weighted(WindowQuad quad) {
  for (std::size_t i = 0; i < 4; ++i) {
    quad.attribute[i].assign(4, 0.0);
    quad.attribute[i][i] = 1;
  }
  return quad;
}

}  // namespace

void set_own_picture(golden::Image8 picture) {
  own_picture = std::make_shared<const golden::Texture>(std::move(picture));
}

Drawing make_drawing(const Request& request) {
  Drawing out;
  out.request = request;
  out.scene = golden::make_scene(request.scene);
  golden::Scene& scene = out.scene;
  out.shade = request.shade.empty() ? scene.shade : request.shade;
  out.texture = request.texture.empty() ? std::string(golden::texture_name(scene.texture)) : request.texture;
  out.texel = texture_of(out.texture);
  if (out.shade == "planes" && !scene.planes)
    throw std::invalid_argument("shade=planes: the scene " + scene.name + " is not cut by planes");

  golden::Camera camera = scene.camera;
  out.matrix = golden::camera_matrix(camera, request.width, request.height);
  out.to_eye = golden::direction_to_eye(camera);
  if (!request.is_scene()) {
    out.matrix = moved(out.matrix, middle(scene.mesh), request);
    camera.matrix = out.matrix;
    out.to_eye = golden::direction_to_eye(camera);
    for (const auto& [vertex, position] : request.vertices) {
      if (static_cast<std::size_t>(vertex) >= scene.mesh.positions.size())
        throw std::invalid_argument("v" + std::to_string(vertex) + ": the scene " + scene.name +
                                    " has vertices v0 to v" + std::to_string(scene.mesh.positions.size() - 1));
      scene.mesh.positions[static_cast<std::size_t>(vertex)] = position;
    }
  }
  golden::ProjectOptions options;
  options.attributes = golden::attributes_for_shade(out.shade);
  if (options.attributes == AttributeSet::weights) options.attributes = AttributeSet::none;
  golden::Projection projection = golden::project_mesh(scene.mesh, camera, request.width, request.height, options);
  out.quads = std::move(projection.quads);
  out.corners = std::move(projection.corners);
  out.textures = std::move(projection.textures);
  out.attributes = golden::attribute_count(options.attributes);
  if (scene.planes) out.planes = *scene.planes;
  if (options.attributes == AttributeSet::position) golden::fit_positions(out.quads, out.planes);

  out.state = draw_state_for(request.config, request.width, request.height);
  out.state.perspective = request.perspective.value_or(scene.perspective);
  out.state.cull = request.cull.value_or(scene.cull);
  out.state.depth = request.depth;
  return out;
}

BareQuads bare_quads(const Drawing& drawing) {
  BareQuads out{drawing.state, {}};
  out.state.attributes = 0;
  for (WindowQuad quad : drawing.quads) {
    quad.id = static_cast<std::uint32_t>(out.quads.size());
    out.quads.push_back(snap_quad(quad, drawing.request.config, out.state));
  }
  return out;
}

Values values_of(const Drawing& drawing) { return drawing.attributes == 0 ? Values::weights : Values::shading; }

FragmentTable draw_fragments(const Drawing& drawing) {
  const Config& config = drawing.request.config;
  const std::vector<tb::Pass> passes = tb::plan_passes(drawing.attributes, true, config);
  FragmentTable out;
  out.columns = 4 + drawing.attributes;
  const auto width = static_cast<std::size_t>(out.columns);
  for (const tb::Pass& pass : passes) {
    const bool first = &pass == &passes.front();
    const DrawState state = tb::state_of_pass(drawing.state, pass, first);
    UntimedModel model(config, state);
    std::size_t at = 0;
    for (std::size_t i = 0; i < drawing.quads.size(); ++i) {
      const SnappedQuad quad =
          tb::snap_as(tb::pass_quad(drawing.quads[i], pass), static_cast<std::uint32_t>(i), config, state);
      model.draw(quad, [&](std::span<const Fragment> fragments) {
        for (const Fragment& f : fragments) {
          if (first) {
            out.quads.push_back(static_cast<std::uint32_t>(i));
            for (const std::uint32_t head : {drawing.quads[i].id, std::uint32_t{f.x}, std::uint32_t{f.y},
                                             std::uint32_t{f.front}, std::uint32_t{f.flags}, f.depth})
              out.heads.push_back(head);
            out.codes.resize(out.codes.size() + width);
          } else {
            out.heads[6 * at + 4] |= f.flags;
          }
          for (std::size_t slot = 0; slot < pass.columns.size(); ++slot)
            out.codes[at * width + static_cast<std::size_t>(pass.columns[slot])] = f.attribute[slot];
          ++at;
        }
      });
    }
    if (first) out.stats = model.stats(), out.lanes = model.lane_pixels();
  }
  return out;
}

namespace {

/// With more attributes than the machine has slots.
Picture picture_of_passes(const Drawing& drawing, int attributes, Values values) {
  const Request& request = drawing.request;
  const FragmentTable table = draw_fragments(drawing);
  Picture out{
      {request.width, request.height, attributes, request.config, drawing.state.depth, true}, table.stats, table.lanes};
  const std::size_t first = values == Values::weights ? 0 : 4, columns = static_cast<std::size_t>(table.columns);
  std::vector<double> value(static_cast<std::size_t>(attributes));
  for (std::size_t f = 0; f < table.quads.size(); ++f) {
    const auto pixel = static_cast<std::size_t>(table.heads[6 * f + 2]) * static_cast<std::size_t>(request.width) +
                       table.heads[6 * f + 1];
    const double depth = std::ldexp(static_cast<double>(table.heads[6 * f + 5]), -request.config.depth_bits);
    if (drawing.state.depth && !(depth < out.image.depth()[pixel])) continue;
    for (std::size_t j = 0; j < value.size(); ++j)
      value[j] =
          std::ldexp(static_cast<double>(table.codes[f * columns + first + j]), -request.config.attribute_frac());
    out.image.overwrite(pixel, depth, value, table.quads[f]);
  }
  return out;
}

/// One quad hides nothing of itself: where its depths are all seen, as those of its corners are, nobody asks for them.
bool needs_depth(const Drawing& drawing) {
  const auto seen = [](const WindowVertex& v) { return v.w > 0 && v.z > 0.001 * v.w && v.z < 0.999 * v.w; };
  return drawing.quads.size() != 1 || drawing.shade == "depth" || drawing.state.znear != 0 || drawing.state.zfar != 1 ||
         !std::ranges::all_of(drawing.quads.front().vertex, seen);
}

}  // namespace

Picture draw_picture(const Drawing& drawing, Values values) {
  const Request& request = drawing.request;
  DrawState state = drawing.state;
  state.depth = state.depth && needs_depth(drawing);
  state.attributes = values == Values::weights ? 4 : drawing.attributes;
  if (state.attributes > request.config.attribute_slots) return picture_of_passes(drawing, state.attributes, values);
  Picture out{{request.width, request.height, state.attributes, request.config, state.depth, true}, {}, {}};
  UntimedModel model(request.config, state);
  for (std::size_t i = 0; i < drawing.quads.size(); ++i) {
    WindowQuad quad = values == Values::weights ? weighted(drawing.quads[i]) : drawing.quads[i];
    quad.id = static_cast<std::uint32_t>(i);
    model.draw_arrays(snap_quad(quad, request.config, state),
                      [&](const FragmentArrays& fragments) { out.image.write(fragments); });
  }
  out.image.settle();
  out.stats = model.stats();
  out.lanes = model.lane_pixels();
  return out;
}

std::vector<std::uint8_t> Shader::shade(const DepthImage<double>& image, Values values) const {
  const int width = image.width(), height = image.height();
  const std::string& mode = drawing_.shade;
  const auto quads = image.quads();
  const auto value = [&](int j, std::size_t pixel) { return image.attribute(j)[pixel]; };
  const auto drawn = [&](std::size_t pixel) { return quads[pixel] != DepthImage<double>::no_quad; };
  const auto lambda = [&](std::size_t p) {
    return std::array<double, 4>{value(0, p), value(1, p), value(2, p), value(3, p)};
  };
  const auto vector = [&](std::size_t p) { return Vec3{value(0, p), value(1, p), value(2, p)}; };
  const Vec3 light = golden::unit_vector(to_light_);
  const auto uv = [&](std::size_t p) -> golden::Vec2 { return {value(0, p), value(1, p)}; };
  const auto planes_height = [&](std::size_t p) {
    return dot(drawing_.planes.normal, vector(p)) / drawing_.planes.spacing - 0.5;
  };
  const auto slope = [&](std::size_t p, int dx, int dy) {
    const int x = static_cast<int>(p) % width, y = static_cast<int>(p) / width;
    for (const int sign : {1, -1}) {
      const int nx = x + sign * dx, ny = y + sign * dy;
      if (nx < 0 || ny < 0 || nx >= width || ny >= height) continue;
      const auto next = static_cast<std::size_t>(ny) * static_cast<std::size_t>(width) + static_cast<std::size_t>(nx);
      if (quads[next] == quads[p]) return planes_height(next) - planes_height(p);
    }
    return 0.0;
  };
  double nearest = 1, farthest = 0;
  if (mode == "depth")
    for (std::size_t p = 0; p < quads.size(); ++p)
      if (drawn(p)) nearest = std::min(nearest, image.depth()[p]), farthest = std::max(farthest, image.depth()[p]);

  std::vector<std::uint8_t> out(4 * quads.size());
  const auto fill = [&](auto&& colour_of) {
    const auto bytes_of = [](const Vec3& colour) {
      std::array<std::uint8_t, 4> bytes{0, 0, 0, 255};
      for (std::size_t c = 0; c < 3; ++c) bytes[c] = golden::to_byte(static_cast<float>(colour[c]));
      return bytes;
    };
    const auto background = bytes_of(golden::background_colour);
    for (std::size_t p = 0; p < quads.size(); ++p) {
      const auto bytes = drawn(p) ? bytes_of(colour_of(p)) : background;
      std::copy(bytes.begin(), bytes.end(), out.begin() + static_cast<std::ptrdiff_t>(4 * p));
    }
  };
  if (mode == "lambda" && values == Values::weights) {
    fill([&](std::size_t p) { return golden::weight_colour(lambda(p)); });
  } else if (mode == "texture") {
    fill([&](std::size_t p) { return drawing_.texel(uv(p)[0], uv(p)[1]); });
  } else if (mode == "uv") {
    fill([&](std::size_t p) { return Vec3{golden::wrapped(uv(p)[0]), golden::wrapped(uv(p)[1]), 0.25}; });
  } else if (mode == "normal") {
    fill([&](std::size_t p) { return golden::phong(vector(p), drawing_.to_eye, light); });
  } else if (mode == "colour") {
    fill(vector);
  } else if (mode == "quad") {
    fill([&](std::size_t p) { return golden::id_colour(drawing_.quads[quads[p]].id); });
  } else if (mode == "depth") {
    fill([&](std::size_t p) {
      const double grey = farthest > nearest ? 0.95 - 0.55 * (image.depth()[p] - nearest) / (farthest - nearest) : 0.95;
      return Vec3{grey, grey, grey};
    });
  } else if (mode == "planes") {
    fill([&](std::size_t p) {
      const Vec3 facet = golden::facet_normal(drawing_.corners[quads[p]]);
      return golden::cut_colour(golden::phong(facet, drawing_.to_eye, light), planes_height(p),
                                std::hypot(slope(p, 1, 0), slope(p, 0, 1)));
    });
  } else {
    throw std::invalid_argument("shade=" + mode +
                                ": expected texture, uv, normal, lambda, depth, quad, planes, colour");
  }
  return out;
}

}  // namespace quadrille::page
