#include "tb/render/frame.hpp"

#include "golden/io/texture.hpp"
#include "golden/reference/truth.hpp"
#include "golden/scenes/shading.hpp"
#include "model/port/snap.hpp"
#include "model/support/parallel.hpp"
#include "tb/support/choices.hpp"
#include "tb/support/errors.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace quadrille::tb {
namespace {

using golden::Vec3;

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

std::size_t slot(int first, int offset) { return static_cast<std::size_t>(first + offset); }

}  // namespace

FrameBuffer::FrameBuffer(int width, int height, bool depth, const Config& config, int attributes, bool weights)
    : depth_(depth),
      attribute_count_(attributes),
      attributes_(width, height, attributes, config, depth, true),
      shows_undefined_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
  if (weights) weights_.emplace(width, height, 4, config, depth);
}

void FrameBuffer::name(std::uint32_t index, std::uint32_t quad) {
  if (index >= quad_of_index_.size()) quad_of_index_.resize(index + std::size_t{1});
  quad_of_index_[index] = quad;
}

void FrameBuffer::show(const EngineSample& sample) {
  const std::size_t pixel = at(sample.x, sample.y);
  const double depth = sample.undefined ? 1 : sample.z;
  attributes_.overwrite(pixel, depth, sample.attribute, sample.index);
  if (weights_) weights_->overwrite(pixel, depth, sample.lambda, sample.index);
  shows_undefined_[pixel] = sample.undefined;
}

void FrameBuffer::add(std::span<const EngineSample> samples) {
  for (const EngineSample& sample : samples) {
    ++fragments_;
    undefined_ += sample.undefined;
    const bool in = sample.undefined ? !drawn(sample.x, sample.y)
                                     : !depth_ || sample.z < attributes_.depth()[at(sample.x, sample.y)];
    if (!in) continue;
    name(sample.index, sample.quad);
    show(sample);
  }
}

void FrameBuffer::add(const QuadFragments& fragments) {
  fragments_ += fragments.common.size;
  name(fragments.index, fragments.quad);
  FragmentArrays arrays = fragments.common;
  arrays.quad = fragments.index;
  std::copy_n(fragments.column.begin() + 4, attribute_count_, arrays.attribute.begin());
  attributes_.write(arrays);
  if (!weights_) return;
  std::copy_n(fragments.column.begin(), 4, arrays.attribute.begin());
  weights_->write(arrays);
}

void FrameBuffer::amend(const Fragment& fragment, std::uint32_t index, const Pass& pass, const Config& config) {
  if (!drawn(fragment.x, fragment.y)) return;
  EngineSample sample = shown(fragment.x, fragment.y);
  if (sample.index != index) return;
  read_columns(fragment, pass, config, sample, false);
  show(sample);
}

EngineSample FrameBuffer::shown(int x, int y) const {
  const std::size_t pixel = at(x, y);
  EngineSample sample;
  sample.x = static_cast<std::uint16_t>(x);
  sample.y = static_cast<std::uint16_t>(y);
  sample.index = attributes_.quads()[pixel];
  sample.quad = sample.index < quad_of_index_.size() ? quad_of_index_[sample.index] : golden::no_quad;
  sample.undefined = shows_undefined_[pixel] != 0;
  sample.z = attributes_.depth()[pixel];
  for (int j = 0; j < attribute_count_; ++j)
    sample.attribute[static_cast<std::size_t>(j)] = attributes_.attribute(j)[pixel];
  if (weights_)
    for (int i = 0; i < 4; ++i) sample.lambda[static_cast<std::size_t>(i)] = weights_->attribute(i)[pixel];
  return sample;
}

std::uint64_t FrameBuffer::pixels_drawn() const {
  const auto quads = attributes_.quads();
  return quads.size() - static_cast<std::uint64_t>(std::ranges::count(quads, DepthImage<double>::no_quad));
}

TextureFunction make_texture(const std::string& file, const DrawInput& input) {
  if (file.empty())
    return [kind = input.texture](double u, double v) { return golden::procedural_texture(kind, u, v); };
  const auto texture = std::make_shared<golden::Texture>(golden::load_png(file));
  return [texture](double u, double v) {
    const std::array<double, 4> rgba = texture->sample(u, v);
    return Vec3{rgba[0], rgba[1], rgba[2]};
  };
}

ShadeSlots shade_slots(const std::string& shade, const DrawInput& input) {
  ShadeSlots slots;
  if (input.layout == AttributeLayout::uv || input.layout == AttributeLayout::uv_normal) slots.uv = 0;
  if (input.layout == AttributeLayout::normal) slots.normal = 0;
  if (input.layout == AttributeLayout::uv_normal) slots.normal = 2;
  if (input.layout == AttributeLayout::position) slots.position = 0;
  if (input.layout == AttributeLayout::colour) slots.colour = 0;
  if (shade == "planes") {
    slots.planes = input.planes;
    for (const auto& corner : input.corners) slots.facets.push_back(golden::facet_normal(corner));
  }
  if (input.layout == AttributeLayout::named) {
    slots.uv = input.slot_of({"u", "v"});
    slots.normal = input.slot_of({"nx", "ny", "nz"});
    slots.colour = input.slot_of({"red", "green", "blue"});
  }
  if (input.layout == AttributeLayout::file) {
    if (input.attributes >= 2) slots.uv = 0;
    if (input.attributes >= 3) slots.normal = input.attributes >= 5 ? 2 : 0;
  }
  if (shade == "normal" && slots.normal < 0)
    throw UsageError(
        "--shade normal: the quads of " + input.name + " have " + std::to_string(input.attributes) +
        " attributes and so no normal (nx, ny, nz; without names three, or five with texture coordinates first)");
  return slots;
}

bool shades_weights(const ShadeSettings& settings) {
  const std::string& shade = settings.shade;
  return shade == "lambda" || (settings.slots.uv < 0 && (shade == "uv" || shade == "texture"));
}

golden::FrameImage shade_frame(const FrameBuffer& frame, const ShadeSettings& settings) {
  frame.settle();
  golden::FrameImage image(frame.width(), frame.height());
  const std::size_t mode = choose("shading", settings.shade, shade_modes());
  const Vec3 &to_eye = settings.lighting.to_eye, to_light = golden::unit_vector(settings.lighting.to_light);

  // Depth is shown between its extremes in the frame.
  double nearest = 1, farthest = 0;
  for (int y = 0; settings.shade == "depth" && y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x) {
      const EngineSample s = frame.shown(x, y);
      if (!frame.drawn(x, y) || s.undefined) continue;
      nearest = std::min(nearest, s.z);
      farthest = std::max(farthest, s.z);
    }
  }

  const auto attribute3 = [](const EngineSample& s, int first) {
    return Vec3{s.attribute[slot(first, 0)], s.attribute[slot(first, 1)], s.attribute[slot(first, 2)]};
  };

  const auto height = [&](const EngineSample& s) {
    return dot(settings.slots.planes.normal, attribute3(s, settings.slots.position)) / settings.slots.planes.spacing -
           0.5;
  };
  const auto slope = [&](const EngineSample& s, int dx, int dy) {
    for (const int sign : {1, -1}) {
      const int x = s.x + sign * dx, y = s.y + sign * dy;
      if (x < 0 || y < 0 || x >= frame.width() || y >= frame.height() || !frame.drawn(x, y)) continue;
      const EngineSample next = frame.shown(x, y);
      if (next.index == s.index && !next.undefined) return height(next) - height(s);
    }
    return 0.0;
  };
  const auto cut = [&](const EngineSample& s) {
    const Vec3 flat = golden::phong(settings.slots.facets[s.index], to_eye, to_light);
    return golden::cut_colour(flat, height(s), std::hypot(slope(s, 1, 0), slope(s, 0, 1)));
  };

  const auto colour_of = [&](const EngineSample& s) -> Vec3 {
    if (s.undefined) return golden::undefined_colour;
    std::array<double, 2> uv{s.lambda[1] + s.lambda[2], s.lambda[2] + s.lambda[3]};  // the unit square
    if (settings.slots.uv >= 0) uv = {s.attribute[slot(settings.slots.uv, 0)], s.attribute[slot(settings.slots.uv, 1)]};
    switch (mode) {
      case 0:
        return {golden::wrapped(uv[0]), golden::wrapped(uv[1]), 0.25};
      case 1:
        return settings.texture(uv[0], uv[1]);
      case 2:
        return golden::phong(attribute3(s, settings.slots.normal), to_eye, to_light);
      case 3:
        return golden::weight_colour(s.lambda);
      case 4: {
        // Down to 0.4: darker ones would pass through the background's grey.
        const double grey = farthest > nearest ? 0.95 - 0.55 * (s.z - nearest) / (farthest - nearest) : 0.95;
        return {grey, grey, grey};
      }
      case 5:
        return golden::id_colour(s.quad);
      case 6:
        return cut(s);
      default:
        return attribute3(s, settings.slots.colour);
    }
  };

  parallel_for(static_cast<std::size_t>(frame.height()), settings.threads, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < frame.width(); ++x) {
      if (!frame.drawn(x, y)) continue;
      const EngineSample s = frame.shown(x, y);
      const std::size_t i = image.index(x, y);
      const Vec3 colour = colour_of(s);
      image.r[i] = static_cast<float>(colour[0]);
      image.g[i] = static_cast<float>(colour[1]);
      image.b[i] = static_cast<float>(colour[2]);
      image.a[i] = 1;
      image.quad[i] = s.quad;
      if (s.undefined) continue;
      if (settings.depth) image.z[i] = static_cast<float>(s.z);
      for (std::size_t k = 0; k < 4; ++k) image.lambda[k][i] = static_cast<float>(s.lambda[k]);
    }
  });
  return image;
}

void add_error_layers(const FrameBuffer& frame, std::span<const WindowQuad> quads, const Config& config,
                      const DrawState& state, bool snap, unsigned threads, golden::FrameImage& image) {
  frame.settle();
  struct Shown {
    std::uint32_t index;
    int x, y;
  };
  std::vector<Shown> shown;
  for (int y = 0; y < frame.height(); ++y)
    for (int x = 0; x < frame.width(); ++x)
      if (frame.drawn(x, y) && !frame.shown(x, y).undefined) shown.push_back({frame.shown(x, y).index, x, y});
  std::stable_sort(shown.begin(), shown.end(), [](const Shown& a, const Shown& b) { return a.index < b.index; });

  std::array<std::vector<float>*, 4> layer{};
  for (std::size_t k = 0; k < 4; ++k) {
    layer[k] = &image.error["L" + std::to_string(k)];
    layer[k]->assign(image.pixels(), 0.0f);
  }
  DrawState weights_only = state;
  weights_only.attributes = 0;
  constexpr std::size_t block = 1024;
  parallel_for((shown.size() + block - 1) / block, threads, [&](std::size_t unit) {
    std::unique_ptr<golden::TruthQuad> truth;
    std::uint32_t current = 0;
    for (std::size_t n = unit * block; n < std::min(shown.size(), (unit + 1) * block); ++n) {
      const auto [index, x, y] = shown[n];
      if (!truth || index != current) {
        truth = snap ? std::make_unique<golden::TruthQuad>(snap_as(quads[index], 0, config, weights_only), config,
                                                           weights_only)
                     : std::make_unique<golden::TruthQuad>(quads[index], weights_only);
        current = index;
      }
      const golden::ReferenceSample expected = truth->sample(x, y);
      for (std::size_t k = 0; k < 4; ++k)
        (*layer[k])[image.index(x, y)] = static_cast<float>(frame.shown(x, y).lambda[k] - expected.lambda[k]);
    }
  });
}

golden::Image8 frame_picture(const golden::FrameImage& image) {
  golden::Image8 picture;
  picture.width = image.width;
  picture.height = image.height;
  picture.rgba.reserve(image.pixels() * 4);
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    const bool drawn = image.a[i] > 0;
    picture.rgba.push_back(golden::to_byte(drawn ? static_cast<double>(image.r[i]) : golden::background_colour[0]));
    picture.rgba.push_back(golden::to_byte(drawn ? static_cast<double>(image.g[i]) : golden::background_colour[1]));
    picture.rgba.push_back(golden::to_byte(drawn ? static_cast<double>(image.b[i]) : golden::background_colour[2]));
    picture.rgba.push_back(255);
  }
  return picture;
}

void save_frame_png(const std::string& path, const golden::FrameImage& image) {
  golden::save_png(path, frame_picture(image), golden::PngFormat::rgb8);
}

}  // namespace quadrille::tb
