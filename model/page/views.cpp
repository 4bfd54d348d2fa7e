#include "model/page/views.hpp"

#include "golden/analysis/error_bound.hpp"
#include "golden/methods/method.hpp"
#include "golden/reference/port_number.hpp"
#include "golden/reference/truth.hpp"
#include "golden/scenes/shading.hpp"
#include "model/drive.hpp"
#include "model/page/weight_error.hpp"
#include "model/support/json.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace quadrille::page {
namespace {

using golden::Vec3;

/// Colours whose order the eye reads without hue too: viridis at 0, 1/4, … 1.
Vec3 scale_colour(double t) {
  static constexpr std::array<Vec3, 5> stops{{{0.267, 0.005, 0.329},
                                              {0.230, 0.322, 0.546},
                                              {0.128, 0.567, 0.551},
                                              {0.369, 0.789, 0.383},
                                              {0.993, 0.906, 0.144}}};
  const double at = std::clamp(t, 0.0, 1.0) * 4;
  const auto i = std::min<std::size_t>(3, static_cast<std::size_t>(at));
  const double rest = at - static_cast<double>(i);
  Vec3 out{};
  for (std::size_t c = 0; c < 3; ++c) out[c] = stops[i][c] + rest * (stops[i + 1][c] - stops[i][c]);
  return out;
}

/// Of what exact coverage has not.
constexpr Vec3 outside_colour{0.84, 0.37, 0.00};

class Canvas {
 public:
  Canvas(int width, int height) : width_(width), rgba_(static_cast<std::size_t>(4 * width * height)) {
    for (std::size_t p = 0; p < rgba_.size() / 4; ++p) put(p, golden::background_colour);
  }
  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y * width_ + x); }
  void put(std::size_t pixel, const Vec3& colour) {
    for (std::size_t c = 0; c < 3; ++c) rgba_[4 * pixel + c] = golden::to_byte(colour[c]);
    rgba_[4 * pixel + 3] = 255;
  }
  std::vector<std::uint8_t> take() { return std::move(rgba_); }

 private:
  int width_;
  std::vector<std::uint8_t> rgba_;
};

/// The nearest of weights in real numbers, as values of the shading.
class RealPicture {
 public:
  RealPicture(const Drawing& drawing, Values values)
      : drawing_(drawing),
        values_(values),
        image_(drawing.request.width, drawing.request.height, values_ == Values::weights ? 4 : drawing.attributes,
               drawing.request.config, drawing.state.depth, true),
        undefined_(static_cast<std::size_t>(drawing.request.width * drawing.request.height)) {}

  void add(std::size_t quad, int x, int y, bool front, bool undefined, double z, const std::array<double, 4>& lambda) {
    const DrawState& state = drawing_.state;
    if (state.cull == (front ? Cull::front : Cull::back)) return;
    if (!undefined && state.depth && !(z >= state.znear && z <= state.zfar)) return;
    const auto pixel = static_cast<std::size_t>(y * image_.width() + x);
    const bool drawn = image_.quads()[pixel] != DepthImage<double>::no_quad;
    if (undefined ? drawn : state.depth && !(z < image_.depth()[pixel])) return;
    std::array<double, max_attribute_slots> value{};
    if (values_ == Values::weights)
      std::copy_n(lambda.begin(), 4, value.begin());
    else
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < static_cast<std::size_t>(drawing_.attributes); ++j)
          value[j] += lambda[i] * drawing_.quads[quad].attribute[i][j];
    image_.overwrite(pixel, undefined ? 1 : z, value, static_cast<std::uint32_t>(quad));
    undefined_[pixel] = undefined;
    fragments_ += 1;
    undefined_count_ += undefined;
  }

  const DepthImage<double>& image() const { return image_; }

  View view() const {
    View out;
    out.rgba = Shader(drawing_).shade(image_, values_);
    for (std::size_t p = 0; p < undefined_.size(); ++p)
      if (undefined_[p])
        for (std::size_t c = 0; c < 3; ++c) out.rgba[4 * p + c] = golden::to_byte(golden::undefined_colour[c]);
    out.json = Json().put("fragments", fragments_).put("undefined", undefined_count_).text();
    return out;
  }

 private:
  const Drawing& drawing_;
  Values values_;
  DepthImage<double> image_;
  std::vector<std::uint8_t> undefined_;
  std::size_t fragments_ = 0, undefined_count_ = 0;
};

/// By exact arithmetic, on the snapped quads.
View exact_view(const Drawing& drawing) {
  RealPicture picture(drawing, values_of(drawing));
  const BareQuads bare = bare_quads(drawing);
  for (std::size_t i = 0; i < bare.quads.size(); ++i) {
    const golden::TruthQuad truth(bare.quads[i], drawing.request.config, bare.state);
    const golden::PixelRect box = truth.rows().bounds();
    for (int y = box.y0; y < box.y1; ++y)
      for (int x = box.x0; x < box.x1; ++x) {
        const golden::ReferenceSample s = truth.sample(x, y);
        if (s.covered && s.visible) picture.add(i, x, y, s.front, false, s.z, s.lambda);
      }
  }
  return picture.view();
}

View by_method(const Drawing& drawing, const std::string& spec) {
  const auto method = golden::methods::make_method(spec);
  RealPicture picture(drawing, values_of(drawing));
  const golden::methods::View view{drawing.request.width, drawing.request.height, drawing.state.perspective};
  std::vector<golden::methods::MethodSample> samples;
  for (std::size_t i = 0; i < drawing.quads.size(); ++i) {
    samples.clear();
    method->draw({drawing.quads[i].vertex, drawing.corners[i], drawing.textures[i], drawing.quads[i].attribute}, view,
                 samples);
    for (const auto& s : samples) picture.add(i, s.x, s.y, s.front, s.undefined, s.z, s.lambda);
  }
  return picture.view();
}

/// Of each shown pixel the error of its weights by the machine's bound; log colours from 2^-8 of it on.
View error_view(const Drawing& drawing, const DepthImage<double>& weights, bool homogeneous) {
  const ErrorBound bound = bound_lambda(drawing.request.config);
  Canvas canvas(weights.width(), weights.height());
  WeightError worst{-1, -1};
  std::size_t outside = 0, undefined = 0;
  constexpr double darkest = -8;
  weight_errors(drawing, weights, 1, [&](const WeightError& of) {
    const std::size_t pixel = canvas.at(of.x, of.y);
    outside += !of.inside;
    undefined += of.inside && std::isnan(of.error);
    if (!of.inside || std::isnan(of.error))
      return canvas.put(pixel, of.inside ? golden::undefined_colour : outside_colour);
    canvas.put(pixel, scale_colour(of.error > 0 ? 1 - std::log2(of.error / bound.value) / darkest : 0));
    if (of.error > worst.error) worst = of;
  });
  return {canvas.take(), Json()
                             .put("worst", worst.error / bound.value)
                             .put("bound", bound.value)
                             .put("x", worst.x)
                             .put("y", worst.y)
                             .put("homogeneous", homogeneous)
                             .put("outside", outside)
                             .put("undefined", undefined)
                             .text()};
}

/// Of the nearest fragment which face it is, and which rule decided; brighter where several fragments lie.
View coverage_view(const Drawing& drawing) {
  const Config& config = drawing.request.config;
  const auto [state, quads] = bare_quads(drawing);
  struct Pixel {
    std::uint32_t depth = 0xffffffff;
    int count = 0;
    std::uint8_t flags = 0;
    bool front = false;
  };
  const int width = drawing.request.width;
  std::vector<Pixel> pixels(static_cast<std::size_t>(width * drawing.request.height));
  UntimedModel model(config, state);
  for (const SnappedQuad& quad : quads)
    model.draw_arrays(quad, [&](const FragmentArrays& f) {
      for (std::size_t n = 0; n < f.size; ++n) {
        Pixel& pixel = pixels[static_cast<std::size_t>(f.place[n].y * width + f.place[n].x)];
        ++pixel.count;
        if (state.depth && f.depth[n] >= pixel.depth) continue;
        pixel.depth = f.depth[n];
        pixel.flags = f.marks[n].flags;
        pixel.front = f.marks[n].front;
      }
    });
  Canvas canvas(width, drawing.request.height);
  std::array<std::size_t, 6> count{};
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    if (pixels[p].count == 0) continue;
    const std::uint8_t flags = pixels[p].flags;
    // Of Okabe and Ito's colours, which colour-blind people tell apart.
    Vec3 colour = pixels[p].front ? Vec3{0.00, 0.45, 0.70} : Vec3{0.90, 0.62, 0.00};
    ++count[pixels[p].front ? 0 : 1];
    if (flags & flag_notch) colour = {colour[0] * 0.65, colour[1] * 0.65, colour[2] * 0.65}, ++count[2];
    if (flags & (flag_on_edge | flag_two_edge)) colour = {0.80, 0.47, 0.65}, ++count[3];
    if (flags & (flag_on_vertex | flag_two_corner)) colour = {0.84, 0.37, 0.00}, ++count[4];
    if (flags & flag_tie) colour = {1, 1, 1}, ++count[5];
    canvas.put(p, colour);
  }
  return {canvas.take(), Json()
                             .put("front", count[0])
                             .put("back", count[1])
                             .put("notch", count[2])
                             .put("on_edge", count[3])
                             .put("on_vertex", count[4])
                             .put("ties", count[5])
                             .text()};
}

/// The clock in which each fragment leaves the clocked machine; with `tiles` which tile it was of, in their order.
View clocks_view(const Drawing& drawing) {
  const Config& config = drawing.request.config;
  const auto [state, quads] = bare_quads(drawing);
  const int width = drawing.request.width;
  std::vector<std::uint64_t> left(static_cast<std::size_t>(width * drawing.request.height));
  DrivenModel machine(config, state);
  machine.wait_idle();
  SteadyBeats beats(quads);
  std::uint64_t last = 0, fragments = 0, first = 0;
  const std::uint64_t clocks = drive(machine, beats, [&](std::uint64_t cycle, const ClockedOutputs& outputs, bool) {
    outputs.for_each_fragment([&](const Fragment& f) {
      left[static_cast<std::size_t>(f.y * width + f.x)] = cycle + 1;
      last = cycle + 1;
      if (fragments++ == 0) first = last;
    });
    return !beats.done() || outputs.busy;
  });
  Canvas canvas(width, drawing.request.height);
  const double span = static_cast<double>(std::max<std::uint64_t>(1, last - first));
  for (std::size_t p = 0; p < left.size(); ++p)
    if (left[p] != 0) canvas.put(p, scale_colour(static_cast<double>(left[p] - first) / span));
  Json counters;
  const PerformanceCounters counted = machine.counters();
  for (std::size_t i = 0; i < counter_count; ++i) counters.put(counter_info[i].name, counted.value[i]);
  return {canvas.take(), Json()
                             .put("clocks", clocks)
                             .put("first", first)
                             .put("last", last)
                             .put("fragments", fragments)
                             .raw("counters", counters.text())
                             .text()};
}

}  // namespace

View draw_view(const Drawing& drawing) {
  const std::string& view = drawing.request.view;
  if (view == "exact") return exact_view(drawing);
  if (view == "error") {
    const Picture picture = draw_picture(drawing, Values::weights);
    return error_view(drawing, picture.image, picture.stats.homogeneous_quads != 0);
  }
  if (view == "coverage") return coverage_view(drawing);
  if (view == "tiles") return tiles_view(drawing);
  if (view == "clocks") return clocks_view(drawing);
  return by_method(drawing, view);
}

std::vector<float> shader_quads(const Drawing& drawing) {
  const Config& config = drawing.request.config;
  const BareQuads bare = bare_quads(drawing);
  std::vector<float> out;
  for (const SnappedQuad& quad : bare.quads) {
    const double base = std::ldexp(static_cast<double>(quad.base.depth), -config.depth_bits);
    const auto each = [&](auto&& number) {
      for (const SnappedVertex& v : quad.vertex) out.push_back(static_cast<float>(number(v)));
    };
    const auto real = [&](std::int32_t code) { return std::ldexp(static_cast<double>(code), -config.frac()); };
    const auto port = [&](const PortNumber& n) { return golden::port_value(n, config.significand_bits); };
    each([&](const SnappedVertex& v) { return real(v.x); });
    each([&](const SnappedVertex& v) { return real(v.y); });
    each([&](const SnappedVertex& v) { return real(v.w); });
    each([&](const SnappedVertex& v) { return bare.state.perspective ? port(v.k) : real(v.w); });
    each([&](const SnappedVertex& v) { return port(v.z) + base * real(v.w); });
  }
  return out;
}

View shader_view(const Drawing& drawing, std::span<const float> pixels) {
  const bool error = drawing.request.view.ends_with("_error");
  RealPicture picture(drawing, error ? Values::weights : values_of(drawing));
  const std::size_t half = pixels.size() / 2;
  for (int y = 0; y < drawing.request.height; ++y)
    for (int x = 0; x < drawing.request.width; ++x) {
      const auto at = static_cast<std::size_t>(4 * (y * drawing.request.width + x));
      const float* weights = &pixels[at];
      const float* seen = &pixels[half + at];
      if (seen[0] == 0) continue;
      std::array<double, 4> lambda{weights[0], weights[1], weights[2], weights[3]};
      const bool finite =
          std::isfinite(seen[1]) && std::ranges::all_of(lambda, [](double l) { return std::isfinite(l); });
      if (!finite && !error) lambda = {};  // no shading takes them
      picture.add(static_cast<std::size_t>(seen[0]) - 1, x, y, seen[2] < 0, !finite, seen[1], lambda);
    }
  return error ? error_view(drawing, picture.image(), false) : picture.view();
}

}  // namespace quadrille::page
