// What the page's worker calls. A request is text (request.hpp), written to the place that input() gives; a call
// returns 0, or 1 with an error; result() is its JSON, bytes() its picture or numbers.
#include "golden/analysis/error_bound.hpp"
#include "golden/analysis/hardware_cost.hpp"
#include "golden/explain/explain.hpp"
#include "golden/scenes/scenes.hpp"
#include "model/page/drawing.hpp"
#include "model/page/stepper.hpp"
#include "model/page/sweep.hpp"
#include "model/page/views.hpp"
#include "model/port/snap.hpp"
#include "model/support/json.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#define EXPORT(name) extern "C" __attribute__((export_name(#name)))

namespace quadrille::page {
namespace {

std::string request_text, result_text;
std::vector<std::uint8_t> result_bytes;
std::optional<Stepper> stepper;
std::optional<Drawing> shaded;  ///< by a shader

const char* name_of(Cull cull) { return cull == Cull::none ? "none" : cull == Cull::front ? "front" : "back"; }

template <class Call>
int answer(Call&& call) {
  try {
    result_bytes.clear();
    result_text = call(request_text);
    return 0;
  } catch (const std::exception& error) {
    result_text = Json().put("error", error.what()).text();
    return 1;
  }
}

std::string scene_list(const std::vector<golden::SceneInfo>& scenes) {
  return Json::list(scenes, [](const golden::SceneInfo& s) {
    return Json().put("name", s.name).put("title", s.title).put("paper", s.paper).put("quads", s.quads).text();
  });
}

std::string key_list() {
  return Json::list(Config::keys(), [](const ConfigKey& k) {
    return Json()
        .put("name", k.name)
        .put("minimum", k.minimum)
        .put("maximum", k.maximum)
        .put("standard", k.standard)
        .put("unit", k.unit)
        .put("meaning", k.meaning)
        .text();
  });
}

/// Of a configuration: what it is, how far off it may be and what it costs.
std::string config_json(const Config& config) {
  Json resolved;
  for (const ConfigKey& key : Config::keys()) resolved.put(key.name, config.resolved(key.name));
  const ErrorBound bound = bound_lambda(config);
  const HardwareCost cost = hardware_cost(config);
  return Json()
      .raw("resolved", resolved.text())
      .put("bound", bound.value)
      .put("proved", bound.proved)
      .put("reason", bound.reason)
      .put("luts", lut_cost(cost, ecp5_weights))
      .put("dsps", cost.dsps)
      .put("block_rams", cost.block_rams)
      .put("state_bits", cost.state_bits)
      .text();
}

std::string stats_json(const DrawStats& s, const LanePixels& lanes) {
  return Json()
      .put("quads", s.quads)
      .put("rejected", s.quads - s.rejected[0])
      .put("homogeneous_quads", s.homogeneous_quads)
      .put("hull_quads", s.hull_quads)
      .put("blocks_tested", s.blocks_tested)
      .put("tiles_tested", s.tiles_tested)
      .put("tiles_entered", s.tiles_entered)
      .put("stamps_covered", s.stamps_covered)
      .put("pixels", s.pixels)
      .put("fragments", s.fragments)
      .put("ties", s.tie)
      .put("on_edge", s.on_edge)
      .put("on_vertex", s.on_vertex)
      .put("notch", s.notch)
      .put("saturated", s.saturated)
      .put("lane_pixels", lanes.wide)
      .put("plain_pixels", lanes.plain)
      .text();
}

std::string drawing_json(const Drawing& d, const Picture& picture) {
  const auto corner = [&](const golden::Vec3& p) {
    const WindowVertex v = golden::project_point(d.matrix, p, d.request.width, d.request.height);
    return Json().raw("position", Json::numbers(p)).put("x", v.x).put("y", v.y).put("z", v.z).put("w", v.w).text();
  };
  const bool handles = d.scene.mesh.positions.size() <= 24;
  return Json()
      .put("scene", d.scene.name)
      .put("shade", d.shade)
      .put("texture", d.texture)
      .put("perspective", d.state.perspective)
      .put("cull", name_of(d.state.cull))
      .put("planes", d.scene.planes.has_value())
      .put("colours", !d.scene.mesh.colours.empty())
      .put("is_scene", d.request.is_scene())
      .put("quads", d.quads.size())
      .raw("matrix", Json::numbers(d.matrix))
      .raw("vertices", handles ? Json::list(d.scene.mesh.positions, corner) : "[]")
      .raw("stats", stats_json(picture.stats, picture.lanes))
      .text();
}

template <class Integer>
void put_bytes(const std::vector<Integer>& values) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(values.data());
  result_bytes.insert(result_bytes.end(), bytes, bytes + values.size() * sizeof(Integer));
}

/// The lines of a .quads file that draws the same.
std::string quads_text(const Drawing& d) {
  std::string out;
  for (const WindowQuad& quad : d.quads) {
    std::string line;
    const auto add = [&](double v) { line += (line.empty() ? "" : " ") + Json::number(v); };
    for (const WindowVertex& v : quad.vertex)
      for (const double c : {v.x, v.y, v.z, v.w}) add(c);
    for (const auto& attributes : quad.attribute)
      for (const double a : attributes) add(a);
    out += line + "\n";
  }
  return out;
}

}  // namespace
}  // namespace quadrille::page

using namespace quadrille;
using namespace quadrille::page;

/// Room for a request of so many bytes.
EXPORT(input) char* input(std::size_t size) {
  request_text.resize(size);
  return request_text.data();
}
EXPORT(result) const char* result() { return result_text.data(); }
EXPORT(result_size) std::size_t result_size() { return result_text.size(); }
EXPORT(bytes) const std::uint8_t* bytes() { return result_bytes.data(); }
EXPORT(bytes_size) std::size_t bytes_size() { return result_bytes.size(); }

/// Scenes and keys there are.
EXPORT(lists) int lists() {
  return answer([](const std::string&) {
    return Json()
        .raw("scenes", scene_list(golden::list_scenes()))
        .raw("workloads", scene_list(golden::list_workloads()))
        .raw("keys", key_list())
        .text();
  });
}

/// Instead of a request: the bytes, red, green, blue, alpha, of a picture that is so wide.
EXPORT(picture) int picture(int width) {
  return answer([&](const std::string& text) {
    golden::Image8 picture;
    picture.width = width;
    picture.height = static_cast<int>(text.size() / 4) / std::max(1, width);
    picture.rgba.assign(text.begin(), text.end());
    set_own_picture(std::move(picture));
    return Json().text();
  });
}

/// Bounds and cost of the request's configuration.
EXPORT(configuration) int configuration() {
  return answer([](const std::string& text) { return config_json(parse_request(text).config); });
}

/// The machine's picture.
EXPORT(draw) int draw() {
  return answer([](const std::string& text) {
    const Drawing drawing = make_drawing(parse_request(text));
    const Values values = values_of(drawing);
    const Picture picture = draw_picture(drawing, values);
    result_bytes = Shader(drawing).shade(picture.image, values);
    return drawing_json(drawing, picture);
  });
}

/// What stands beside it.
EXPORT(view) int view() {
  return answer([](const std::string& text) {
    View view = draw_view(make_drawing(parse_request(text)));
    result_bytes = std::move(view.rgba);
    return view.json;
  });
}

/// What a shader draws of the request: bytes are floats (views.hpp).
EXPORT(shader_quads) int shader_quads() {
  return answer([](const std::string& text) {
    shaded = make_drawing(parse_request(text));
    put_bytes(page::shader_quads(*shaded));
    const DrawState& state = shaded->state;
    return Json()
        .put("width", state.width)
        .put("height", state.height)
        .put("perspective", state.perspective)
        .put("depth", state.depth)
        .put("cull", name_of(state.cull))
        .put("znear", state.znear)
        .put("zfar", state.zfar)
        .text();
  });
}
/// Instead of a request: what the shader drew of the one before, as floats (views.hpp).
EXPORT(shader_view) int shader_view() {
  return answer([](const std::string& text) {
    if (!shaded) throw std::logic_error("shader_view: shader_quads comes first");
    std::vector<float> pixels(text.size() / sizeof(float));
    if (pixels.size() != std::size_t{8} * static_cast<std::size_t>(shaded->state.width * shaded->state.height))
      throw std::invalid_argument("shader_view: expected eight floats a pixel");
    std::memcpy(pixels.data(), text.data(), text.size());
    View view = page::shader_view(*shaded, pixels);
    result_bytes = std::move(view.rgba);
    return view.json;
  });
}

/// The request's pixel, taken apart: of each quad that covers it, or of the one that there is.
EXPORT(pixel) int pixel() {
  return answer([](const std::string& text) {
    const Drawing drawing = make_drawing(parse_request(text));
    if (!drawing.request.pixel) throw std::invalid_argument("pixel: expected pixel=X,Y");
    const auto [x, y] = *drawing.request.pixel;
    DrawState state = drawing.state;
    state.attributes = std::min(drawing.attributes, drawing.request.config.attribute_slots);
    std::vector<explain::Explanation> all = explain::explain(drawing.request.config, state, drawing.quads, x, y);
    const std::string summary = explain::summary(all);
    if (all.size() > 1) std::erase_if(all, [](const explain::Explanation& e) { return !e.covered(); });
    return Json()
        .put("x", x)
        .put("y", y)
        .put("summary", summary)
        .raw("quads", Json::list(all, [](const explain::Explanation& e) { return explain::to_json(e); }))
        .text();
  });
}

/// Every fragment: bytes are six 32-bit integers of each (quad, x, y, front, flags, depth), then `columns` 64-bit codes
/// of each (l0 to l3, attributes).
EXPORT(fragments) int fragments() {
  return answer([](const std::string& text) {
    const Drawing drawing = make_drawing(parse_request(text));
    const FragmentTable table = draw_fragments(drawing);
    put_bytes(table.heads);
    put_bytes(table.codes);
    return Json()
        .put("fragments", table.heads.size() / 6)
        .put("columns", table.columns)
        .put("attribute_frac", drawing.request.config.attribute_frac())
        .put("depth_bits", drawing.request.config.depth_bits)
        .put("depth", drawing.state.depth)
        .text();
  });
}

/// What other significands cost and gain on the same quads.
EXPORT(sweep) int sweep() {
  return answer([](const std::string& text) { return sweep_json(make_drawing(parse_request(text))); });
}

/// The clocked machine, before its first clock.
EXPORT(machine_start) int machine_start() {
  return answer([](const std::string& text) {
    stepper.emplace(make_drawing(parse_request(text)));
    return stepper->json();
  });
}
/// Clocks; bytes are x | y << 16 of the fragments that left in them.
EXPORT(machine_run) int machine_run(int clocks, int stall) {
  return answer([&](const std::string&) {
    if (!stepper) throw std::logic_error("machine_run: machine_start comes first");
    stepper->run(clocks, stall);
    put_bytes(stepper->take_fragments());
    return stepper->json();
  });
}

/// The quads as text.
EXPORT(quads) int quads() {
  return answer([](const std::string& text) {
    const Drawing drawing = make_drawing(parse_request(text));
    return Json().put("attributes", drawing.attributes).put("text", quads_text(drawing)).text();
  });
}
