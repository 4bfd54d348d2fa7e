#include "tb/options/options.hpp"

#include "golden/io/config_file.hpp"
#include "model/port/config_text.hpp"
#include "model/port/draw_state.hpp"
#include "tb/device/build_notice.hpp"
#include "tb/device/verilate.hpp"
#include "tb/options/command_line.hpp"
#include "tb/options/named_config.hpp"
#include "tb/options/written_file.hpp"
#include "tb/support/choices.hpp"
#include "tb/support/errors.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <thread>
#include <tuple>

namespace quadrille::tb {
namespace {

/// All of `text` as a number; throws UsageError naming `what`.
template <class Number>
Number parse(std::string_view text, const std::string& what) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || text.empty())
    throw UsageError(what + ": \"" + std::string(text) + "\" is not a whole number in range");
  return value;
}

/// What to --set for a viewport of so many pixels: guard bits are given up for it first, then subpixel bits.
std::string larger_viewport(const Config& config, int pixels) {
  for (Config larger = config; larger.viewport_bits < 15; ++larger.viewport_bits) {
    if (pixels > 1 << larger.viewport_bits) continue;
    for (Config fitting = larger; fitting.subpixel_bits >= 2; --fitting.subpixel_bits)
      for (fitting.guard_bits = larger.guard_bits; fitting.guard_bits >= 1; --fitting.guard_bits) {
        try {
          fitting.validate();
        } catch (const ConfigError&) {
          continue;
        }
        std::string advice = "; for this size --set viewport_bits=" + std::to_string(fitting.viewport_bits);
        for (const char* key : {"guard_bits", "subpixel_bits"})
          if (fitting.get(key) != config.get(key))
            advice += " --set " + std::string(key) + "=" + std::to_string(fitting.get(key));
        return advice;
      }
  }
  return "";
}

const std::array<std::string, 3> cull_names{"none", "front", "back"};  // in the order of Cull

/// all, none, or names with commas between. `hidden` is among all where the machine can and there is a depth test: the
/// pictures of this program are drawn as that skip asks for. `plane`, where the machine can.
std::uint32_t parse_skips(std::string_view list, const Config& config, bool depth) {
  const bool can_hide = config.hierarchical_z_bits != 0;
  const bool can_plane = config.plane_quads != 0;
  if (list == "all") return skip_default | (can_hide && depth ? skip_hidden : 0u) | (can_plane ? skip_plane : 0u);
  if (list == "none") return 0;
  const std::vector<std::string> names(skip_names.begin(), skip_names.end());
  std::uint32_t skips = 0;
  while (true) {
    const std::size_t comma = std::min(list.find(','), list.size());
    skips |= 1u << choose("--skip value (all, none, or names with commas between)", list.substr(0, comma), names);
    if ((skips & skip_hidden) != 0 && !can_hide)
      throw UsageError("--skip hidden needs hierarchical_z_bits, such as --set hierarchical_z_bits=12");
    if ((skips & skip_hidden) != 0 && !depth) throw UsageError("--skip hidden conflicts with --no-depth");
    if ((skips & skip_plane) != 0 && !can_plane) throw UsageError("--skip plane needs --set plane_quads=1");
    if (comma == list.size()) return skips;
    list.remove_prefix(comma + 1);
  }
}

std::string skips_text(std::uint32_t skips) {
  if (skips == 0) return "none";
  std::string text;
  for (std::size_t i = 0; i < skip_names.size(); ++i)
    if ((skips >> i & 1) != 0) text += (text.empty() ? "" : ",") + std::string(skip_names[i]);
  return text;
}

/// Shortest decimal text of a number.
std::string number(double value) {
  std::array<char, 40> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return error == std::errc{} ? std::string(buffer.data(), end) : std::string("nan");
}

}  // namespace

CLI::Validator whole_number(std::uint64_t most) {
  return CLI::Validator(
      [most](std::string& text) {
        errno = 0;
        char* end = nullptr;
        const unsigned long long value = std::strtoull(text.c_str(), &end, 0);
        const bool good = !text.empty() && std::isdigit(static_cast<unsigned char>(text[0])) != 0 && *end == '\0' &&
                          errno == 0 && value <= most;
        return good ? std::string() : "must be a whole number from 0 to " + std::to_string(most) + ": " + text;
      },
      "", "whole number");
}

void CommonOptions::add_to(CLI::App& app, bool draws) {
  app.add_option("--config", config_file,
                 "Configuration: a file, or a name of `quadrille config --list`; `quadrille config` lists the keys")
      ->type_name("F.toml|NAME")
      ->transform(config_path)
      ->group(config_group);
  app.add_option("--set", settings, "One configuration key, after --config; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->group(config_group);
  if (draws) {
    app.add_option("--size", size, "Viewport in pixels")->type_name("WxH")->capture_default_str()->group(state_group);
    add_seed_and_threads(app);
  }
  writes_file(app, app.add_option("--json", json, "JSON report; - is standard output"), "json")->group(output_group);
  auto* be_quiet = app.add_flag("--quiet", quiet, "Print only errors")
                       ->each([](const std::string&) { BuildNotice::silence(); })
                       ->group(output_group);
  app.add_flag("--verbose", verbose, "Print more")->excludes(be_quiet)->group(output_group);
}

void CommonOptions::add_seed_and_threads(CLI::App& app) {
  app.add_option("--seed", seed, "Seed of all random choices")
      ->check(whole_number())
      ->type_name("N")
      ->capture_default_str()
      ->group(general_group);
  app.add_option("--threads", threads, "Threads, 0: one per processor; results do not depend on it")
      ->type_name("N")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str()
      ->group(general_group);
}

Config CommonOptions::config() const {
  Config result;
  std::vector<std::string> notes;
  if (!config_file.empty()) notes = golden::load_config(config_file, result);
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError("--set " + setting + ": expected KEY=VALUE, such as --set significand_bits=24");
    const std::string key = setting.substr(0, equals), value = setting.substr(equals + 1);
    result.get(key);  // an unknown key is the better complaint than its value
    if (value == "auto")
      result.set(key, -1);
    else if (key == "notch_exact" && (value == "true" || value == "false"))
      result.set(key, value == "true" ? 1 : 0);
    else if (const std::optional<int> number = toml_integer(value))
      result.set(key, *number);
    else
      throw UsageError("--set " + key + ": expected a TOML integer in range, not \"" + value + "\"");
    if (const std::string note = Config::note(key); !note.empty()) notes.push_back(note);
  }
  result.validate();
  static std::set<std::string> said;  // a command may ask for the configuration several times
  for (const std::string& note : notes)
    if (!quiet && said.insert(note).second) std::fprintf(stderr, "note: %s\n", note.c_str());
  return result;
}

std::pair<int, int> CommonOptions::viewport(const Config& config) const {
  const std::size_t cross = size.find('x');
  if (cross == std::string::npos) throw UsageError("--size " + size + ": expected WxH, such as --size 640x480");
  const auto width = parse<int>(std::string_view(size).substr(0, cross), "--size " + size);
  const auto height = parse<int>(std::string_view(size).substr(cross + 1), "--size " + size);
  const int limit = 1 << config.viewport_bits;
  if (width < 1 || height < 1)
    throw UsageError("--size " + size + ": width and height must be at least 1, such as --size 640x480");
  if (width > limit || height > limit)
    throw UsageError("--size " + size + ": width and height must be from 1 to " + std::to_string(limit) +
                     " (viewport_bits = " + std::to_string(config.viewport_bits) + ")" +
                     larger_viewport(config, std::max(width, height)));
  return {width, height};
}

unsigned CommonOptions::thread_count() const {
  if (threads > 0) return static_cast<unsigned>(threads);
  return std::max(1u, std::thread::hardware_concurrency());
}

std::FILE* CommonOptions::text() const {
  if (quiet) return nullptr;
  return json == "-" ? stderr : stdout;
}

void StateOptions::add_to(CLI::App& app) {
  app.add_option("--cull", cull, "Faces to cull: none, front or back")
      ->type_name("FACES")
      ->capture_default_str()
      ->group(state_group);
  app.add_flag("--no-perspective", no_perspective, "Interpolate attributes in screen space")->group(state_group);
  app.add_flag("--no-depth", no_depth, "No window z: no depth output, near or far discard")->group(state_group);
  app.add_option("--znear", znear, "Discard fragments with smaller window z")
      ->type_name("Z")
      ->capture_default_str()
      ->group(state_group);
  app.add_option("--zfar", zfar, "Discard fragments with larger window z")
      ->type_name("Z")
      ->capture_default_str()
      ->group(state_group);
  app.add_option("--scissor", scissor, "Pixel rectangle to draw in, without column X1 and row Y1")
      ->type_name("X0,Y0,X1,Y1")
      ->group(state_group);
  app.add_option("--skip", skip,
                 "Work to leave out: all, none or a list\n"
                 "  tiles     blocks and tiles without covered pixels\n"
                 "  quads     quads without fragments\n"
                 "  walk      parts of homogeneous quads outside the scissor\n"
                 "  operands  work that a pixel's fragment does not depend on\n"
                 "  hidden    tiles behind earlier quads (the picture stays; needs hierarchical_z_bits)\n"
                 "  plane     weights of plane quads (needs plane_quads)")
      ->type_name("LIST")
      ->capture_default_str()
      ->group(state_group);
}

DrawState StateOptions::state(const CommonOptions& common, const Config& config) const {
  DrawState state;
  std::tie(state.width, state.height) = common.viewport(config);
  state.scissor_x1 = state.width;
  state.scissor_y1 = state.height;
  if (!scissor.empty()) {
    std::array<int, 4> edge{};
    std::string_view rest = scissor;
    for (std::size_t i = 0; i < edge.size(); ++i) {
      const std::size_t comma = i + 1 < edge.size() ? rest.find(',') : rest.size();
      if (comma == std::string_view::npos) throw UsageError("--scissor " + scissor + ": expected X0,Y0,X1,Y1");
      edge[i] = parse<int>(rest.substr(0, comma), "--scissor " + scissor);
      rest.remove_prefix(std::min(rest.size(), comma + 1));
    }
    state.scissor_x0 = edge[0], state.scissor_y0 = edge[1], state.scissor_x1 = edge[2], state.scissor_y1 = edge[3];
  }
  state.cull = static_cast<Cull>(choose("--cull value", cull, {cull_names.begin(), cull_names.end()}));
  state.perspective = !no_perspective;
  state.depth = !no_depth;
  state.znear = znear;
  state.zfar = zfar;
  state.skip = parse_skips(skip, config, state.depth);
  DrawState checked = state;
  checked.attributes = 0;  // whoever draws says how many
  try {
    check_draw_state(checked, config);
  } catch (const DrawStateError& error) {
    if (error.field == "scissor") throw UsageError("--scissor " + scissor + ": " + error.rule);
    if (error.field == "znear..zfar") throw UsageError("--znear, --zfar: " + error.rule);
    throw UsageError(error.what());
  }
  return state;
}

StateOptions StateOptions::of(const DrawState& state) {
  StateOptions options;
  options.cull = cull_names[static_cast<std::size_t>(state.cull)];
  options.no_perspective = !state.perspective;
  options.no_depth = !state.depth;
  options.znear = state.znear;
  options.zfar = state.zfar;
  options.skip = skips_text(state.skip);
  if (state.scissor_x0 != 0 || state.scissor_y0 != 0 || state.scissor_x1 != state.width ||
      state.scissor_y1 != state.height)
    options.scissor = std::to_string(state.scissor_x0) + "," + std::to_string(state.scissor_y0) + "," +
                      std::to_string(state.scissor_x1) + "," + std::to_string(state.scissor_y1);
  return options;
}

std::string StateOptions::spelled() const {
  std::string text;
  if (cull != "none") text += " --cull " + cull;
  if (no_perspective) text += " --no-perspective";
  if (no_depth) text += " --no-depth";
  if (znear != 0) text += " --znear " + number(znear);
  if (zfar != 1) text += " --zfar " + number(zfar);
  if (!scissor.empty()) text += " --scissor " + scissor;
  if (skip != StateOptions{}.skip) text += " --skip " + skip;
  return text;
}

double probability(const char* name, double value) {
  if (!(value >= 0 && value < 1)) throw UsageError(std::string(name) + ": expected a probability, 0 <= P < 1");
  return value;
}

void InputOptions::add_to(CLI::App& app) {
  constexpr const char* group = "Input";
  app.add_option("--scene", scene, "Built-in scene; `quadrille scenes` lists them")->type_name("NAME")->group(group);
  app.add_option("--mesh", mesh, "Polygon mesh: F.obj, F.ply, F.off, F.gltf, F.glb")->type_name("FILE")->group(group);
  app.add_flag(
         "--merge-pairs", merge_pairs,
         "Join triangles of --mesh to quads: those that share\nan edge and follow each other, as many as possible")
      ->group(group);
  app.add_option("--camera", camera, "Camera for --mesh (default: frames the mesh)")->type_name("F.json")->group(group);
  app.add_option("--view", view,
                 "From where the default camera looks (default: front, slightly right and above)\n"
                 "  front, back, left, right, top, bottom\n"
                 "  -z     an axis, with or without sign\n"
                 "  X,Y,Z  a direction from the mesh to the eye")
      ->type_name("SIDE")
      ->group(group);
  app.add_option("--up", up,
                 "Axis or X,Y,Z that points up (default: y)\n"
                 "  y  the front is +z\n"
                 "  z  the front is -y")
      ->type_name("AXIS")
      ->group(group);
  writes_file(app, app.add_option("--save-camera", save_camera, "Write the camera of --mesh for --camera"), "json")
      ->group(group);
  app.add_option("--quads", quads, "Quads in homogeneous window coordinates")->type_name("F.quads")->group(group);
  app.add_option("--stress", stress, "Random quads of a family; `quadrille scenes --stress` lists them")
      ->type_name("FAMILY")
      ->group(group);
  app.add_option("--count", count, "Number of quads of --stress")
      ->type_name("N")
      ->capture_default_str()
      ->check(CLI::Range(1, 10'000'000))
      ->group(group);
  app.add_option("--corner", corner, "Directed quads of a rare case; `quadrille scenes --corner` lists them")
      ->type_name("GROUP")
      ->group(group);
  app.add_flag("--strict", strict, "Refuse faces of --mesh with more than four corners")->group(group);
}

void add_attributes_option(CLI::App& app, std::string& shade) {
  app.add_option("--shade", shade,
                 "Attributes: uv, texture, normal, planes or colour; lambda, depth, quad: none (default: by input)")
      ->type_name("MODE")
      ->group("Input");
}

void InputOptions::add_picture_options(CLI::App& app, std::string& shade, std::string& texture) {
  app.add_option("--shade", shade, "uv, texture, normal, lambda, depth, quad, planes or colour (default: by input)")
      ->type_name("MODE")
      ->group(output_group);
  app.add_option("--texture", texture, "Texture for --shade texture (default: a pattern of the input)")
      ->type_name("F.png")
      ->group(output_group);
  app.add_option("--light", light,
                 "Light for --shade normal and planes (default: headlight with --mesh, else 0.35,0.8,0.6)\n"
                 "  headlight  at the eye\n"
                 "  -z         from an axis, with or without sign\n"
                 "  X,Y,Z      from a direction")
      ->type_name("LIGHT")
      ->group(output_group);
}

void EngineOptions::add_to(CLI::App& app, std::string& method, bool fp32) {
  single = fp32;
  std::string help = "Engine that draws";
  for (const std::string& name : engine_choices(fp32))
    help += "\n  " + name + std::string(8 - name.size(), ' ') + std::string(engine_info(engine_kind(name, fp32)).help);
  app.add_option("--engine", engine, help)->type_name("ENGINE")->capture_default_str();
  app.add_option("--snap", snap,
                 std::string("Draw snapped quads: float, ") + (fp32 ? "fp32, " : "") + "shader and truth")
      ->type_name("on|off")
      ->capture_default_str();
  app.add_option("--stall", stall, "rtl: probability per clock that the output is not ready (default: 0)")
      ->type_name("P");
  app.add_option("--gap", gap, "rtl: probability per clock that no vertex is offered (default: 0)")->type_name("P");
  app.add_option("--method", method, "Method of the papers as engine; `quadrille compare --help` lists them")
      ->type_name("METHOD")
      ->excludes("--engine")
      ->excludes("--snap");
}

EngineSettings EngineOptions::settings(const CommonOptions& common, const StateOptions& state) const {
  EngineSettings s;
  s.kind = engine_kind(engine, single);
  s.config = common.config();
  s.state = state.state(common, s.config);
  s.snap = choose("--snap value", snap, {"on", "off"}) == 0;
  s.threads = common.thread_count();
  s.seed = common.seed;
  s.stall = probability("--stall", stall);
  s.gap = probability("--gap", gap);
  if (s.kind != EngineKind::rtl && (stall != 0 || gap != 0))
    throw UsageError("--stall and --gap need --engine rtl, not " + engine);
  if (engine_info(s.kind).machine && !s.snap)
    throw UsageError("--snap off needs engine float, fp32, shader or truth; the machine takes snapped quads");
  return s;
}

std::string spelled(const Config& config) { return changed_keys(config, " --set "); }

}  // namespace quadrille::tb
