#include "golden/vectors/machine_suite.hpp"

#include "golden/io/error.hpp"
#include "golden/io/exr.hpp"
#include "golden/io/image_diff.hpp"
#include "golden/scenes/random_quads.hpp"
#include "golden/scenes/stress.hpp"
#include "golden/vectors/machine_run.hpp"
#include "model/port/boundaries.hpp"
#include "model/port/draw_state.hpp"
#include "model/port/latency.hpp"
#include "model/port/snap.hpp"
#include "model/support/parallel.hpp"
#include "model/untimed.hpp"

#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <string>

namespace quadrille::vectors {
namespace {

constexpr std::size_t stall_clocks = 1024;
constexpr int picture_size = 64;  // pixels of a side
constexpr std::uint64_t level_fragments[] = {3'000, 300'000};

// ---- Records ----

struct StateRecord {
  DrawState state;
  std::uint32_t znear = 0, zfar = 0;
};

template <class R, class F>
void visit_record(R& r, const Config& c, F&& f) requires std::same_as<std::remove_const_t<R>, StateRecord> {
  visit_state(r.state, r.znear, r.zfar, c, f);
}

struct VertexRecord {
  std::uint32_t draw = 0;
  VertexBeat beat;
};

constexpr FieldType draw_field = plain("draw", 16, "line of states.hex");

template <class R, class F>
void visit_record(R& r, const Config& c, F&& f) requires std::same_as<std::remove_const_t<R>, VertexRecord> {
  f(draw_field, -1, r.draw);
  visit(r.beat, c, f);
}

struct FragmentRecord {
  std::uint32_t draw = 0, clock = 0, clock_stalled = 0;
  Fragment fragment;
};

template <class R, class F>
void visit_record(R& r, const Config& c, F&& f) requires std::same_as<std::remove_const_t<R>, FragmentRecord> {
  f(draw_field, -1, r.draw);
  f(plain("clock", 32, "handed over in this clock of the draw, without stalls", "clocks"), -1, r.clock);
  f(plain("clock_stalled", 32, "the same with the pattern of stalls.hex", "clocks"), -1, r.clock_stalled);
  visit(r.fragment, c, f);
}

/// A line for each line of stimulus.hex.
struct BeatRecord {
  std::uint32_t draw = 0, clock = 0, clock_stalled = 0;
};

template <class R, class F>
void visit_record(R& r, const Config&, F&& f) requires std::same_as<std::remove_const_t<R>, BeatRecord> {
  f(draw_field, -1, r.draw);
  f(plain("clock", 32, "the beat is taken in this clock of the draw, without stalls", "clocks"), -1, r.clock);
  f(plain("clock_stalled", 32, "the same with the pattern of stalls.hex", "clocks"), -1, r.clock_stalled);
}

template <class R, class F>
void visit_record(R& r, const Config&, F&& f) requires std::same_as<std::remove_const_t<R>, StallClock> {
  f(plain("offer", 1, "a beat may be offered from this clock on"), -1, r.offer);
  f(plain("ready", 1, "a fragment is taken in this clock"), -1, r.ready);
}

template <class R>
RecordLayout record_layout(const Config& config) {
  return layout_of([&, record = R{}](auto& f) { visit_record(record, config, f); });
}

template <class R>
Record packed(const R& record, const Config& config, const RecordLayout& layout) {
  return pack_record(layout.bits(), [&](auto& f) { visit_record(record, config, f); });
}

template <class R>
R unpacked(const Record& bits, const Config& config) {
  R record;
  visit_record(record, config, RecordUnpacker(bits));
  return record;
}

/// The records of a machine suite for one configuration.
struct Layouts {
  RecordLayout state, vertex, beat, fragment, stall;

  explicit Layouts(const Config& config)
      : state(record_layout<StateRecord>(config)),
        vertex(record_layout<VertexRecord>(config)),
        beat(record_layout<BeatRecord>(config)),
        fragment(record_layout<FragmentRecord>(config)),
        stall(record_layout<StallClock>(config)) {}
};

// ---- Draws ----

/// Cuts a draw off after the quad with which it has `limit` fragments, or after `limit` quads, never before the first;
/// with `some`, not before its first fragment either. Returns how many fragments it has.
std::uint64_t limit_draw(MachineDraw& draw, const Config& config, std::uint64_t limit, bool some) {
  UntimedModel model(config, draw.state);
  std::size_t count = 0;
  const auto go_on = [&] {
    const std::uint64_t fragments = model.stats().fragments;
    return fragments < limit && (count < limit || (some && fragments == 0));
  };
  while (count < draw.quads.size() && go_on()) model.draw_arrays(draw.quads[count++], [](const FragmentArrays&) {});
  draw.quads.resize(count);
  return model.stats().fragments;
}

/// How many quads of a draw have ids of their own.
std::size_t most_quads(const Config& config) { return std::size_t{1} << config.quad_id_bits; }

[[noreturn]] void refuse_empty(const std::string& suite, const GenerateOptions& options, std::size_t quads) {
  throw golden::InputError("suite " + suite + ": the first " + std::to_string(quads) +
                           " quads draw no fragment with this seed and configuration (limit " +
                           std::to_string(options.limit) + "); expected vectors");
}

std::uint64_t fragment_limit(const GenerateOptions& options) {
  return options.limit != 0 ? options.limit : level_fragments[options.level - 1];
}

DrawState picture_state(const Config& config) {
  DrawState state = tb::small_state(config, picture_size);
  state.attributes = std::min(4, config.attribute_slots);
  return state;
}

/// Two rectangles of 16 × 8 pixels on corners of tiles, one behind the other.
std::vector<SnappedQuad> two_layers(const Config& config, const DrawState& state) {
  std::vector<SnappedQuad> quads;
  for (const double z : {0.05, 0.95}) {
    WindowQuad quad;
    quad.id = static_cast<std::uint32_t>(quads.size());
    quad.vertex = {{{16, 16, z, 1}, {16, 24, z, 1}, {32, 24, z, 1}, {32, 16, z, 1}}};
    for (auto& attribute : quad.attribute) attribute.assign(static_cast<std::size_t>(state.attributes), 0.5);
    quads.push_back(snap_quad(quad, config, state));
  }
  return quads;
}

/// The same random quads under every draw state.
std::vector<MachineDraw> every_state(const GenerateOptions& options) {
  const DrawState normal = picture_state(options.config);
  std::vector<DrawState> states{normal};
  const auto add = [&](auto&& change) {
    states.push_back(normal);
    change(states.back());
  };
  add([](DrawState& s) { s.perspective = false; });
  add([](DrawState& s) { s.depth = false; });
  add([](DrawState& s) { s.cull = Cull::front; });
  add([](DrawState& s) { s.cull = Cull::back; });
  add([](DrawState& s) { s.znear = 0.375, s.zfar = 0.625; });
  add([](DrawState& s) { s.scissor_x0 = 5, s.scissor_y0 = 9, s.scissor_x1 = 37, s.scissor_y1 = 30; });
  add([](DrawState& s) { s.scissor_x1 = s.scissor_x0; });
  add([](DrawState& s) { s.attributes = 0; });
  add([](DrawState& s) { s.attributes = 1; });
  add([](DrawState& s) { s.skip = 0; });
  if (options.config.hierarchical_z_bits != 0) add([](DrawState& s) { s.skip |= skip_hidden; });
  std::vector<MachineDraw> draws;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const auto count = static_cast<int>(std::min<std::size_t>(2000, most_quads(options.config)));
    draws.push_back({states[i], tb::random_quads(options.config, states[i], options.seed + i, count)});
    // Something to hide before the limit is reached
    if ((states[i].skip & skip_hidden) != 0)
      std::ranges::copy(two_layers(options.config, states[i]), draws.back().quads.begin());
    // The other states may draw nothing, such as that with an empty scissor rectangle.
    const std::uint64_t fragments =
        limit_draw(draws.back(), options.config, fragment_limit(options) / states.size() + 1, i == 0);
    if (i == 0 && fragments == 0) refuse_empty("machine", options, draws.back().quads.size());
  }
  return draws;
}

std::vector<MachineDraw> stress_draw(golden::StressFamily family, const GenerateOptions& options) {
  MachineDraw draw;
  draw.state = picture_state(options.config);
  const std::uint64_t limit = fragment_limit(options);
  // Small families need many quads, and with a small limit the first ones may miss every pixel.
  const std::size_t most = most_quads(options.config);
  for (std::size_t count : {std::max<std::size_t>(16, static_cast<std::size_t>(limit / 4)), std::size_t{4096}}) {
    count = std::min(count, most);
    draw.quads.clear();
    for (const WindowQuad& quad : golden::make_stress(family, count, options.seed, 1, picture_size, picture_size,
                                                      std::max(4, draw.state.attributes)))
      draw.quads.push_back(snap_quad(quad, options.config, draw.state));
    if (limit_draw(draw, options.config, limit, true) > 0) return {std::move(draw)};
  }
  refuse_empty("stress_" + std::string(golden::stress_family_name(family)), options, draw.quads.size());
}

// ---- Pictures ----

/// A draw's picture: depth-tested (or in order, with depth off); weights as far as there are slots for them, colours
/// from the weights.
class Picture {
 public:
  /// At least as large as the suites' own pictures; larger for a larger scissor rectangle.
  Picture(const DrawState& state, const Config& config)
      : state_(state),
        config_(config),
        image_(std::max(picture_state(config).width, state.scissor_x1),
               std::max(picture_state(config).height, state.scissor_y1)) {}

  const golden::FrameImage& image() const { return image_; }
  bool holds(const Fragment& g) const { return g.x < image_.width && g.y < image_.height; }

  void draw(const Fragment& g) {
    const std::size_t at = image_.index(g.x, g.y);
    const auto z = static_cast<float>(std::ldexp(static_cast<double>(g.depth), -config_.depth_bits));
    if (state_.depth && !(z < image_.z[at])) return;
    if (state_.depth) image_.z[at] = z;
    image_.quad[at] = g.quad;
    image_.a[at] = 1;
    for (std::size_t j = 0; j < std::min<std::size_t>(4, static_cast<std::size_t>(state_.attributes)); ++j)
      image_.lambda[j][at] =
          static_cast<float>(std::ldexp(static_cast<double>(g.attribute[j]), -config_.attribute_frac()));
    // Corner colours black, red, green, blue.
    image_.r[at] = image_.lambda[1][at];
    image_.g[at] = image_.lambda[2][at];
    image_.b[at] = image_.lambda[3][at];
  }

 private:
  const DrawState& state_;
  const Config& config_;
  golden::FrameImage image_;
};

std::string picture_name(std::size_t draw) { return "image_" + std::to_string(draw) + ".exr"; }

/// A file that disappears at the end of the scope.
struct TemporaryFile {
  std::string path = (std::filesystem::temp_directory_path() / "quadrille_picture.XXXXXX").string();
  TemporaryFile() {
    const int fd = ::mkstemp(path.data());
    if (fd < 0) throw golden::InputError(path + ": cannot be made: " + std::strerror(errno));
    ::close(fd);
  }
  ~TemporaryFile() { ::unlink(path.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
};

/// Both runs of a draw.
struct DrawRun {
  MachineRun free, stalled;
};

/// The expected lines of a draw, in the order of beats.hex and response.hex.
template <class Sink>
void beat_lines(std::size_t draw, const DrawRun& run, const Config& config, const RecordLayout& layout, Sink&& sink) {
  for (std::size_t n = 0; n < run.free.taken.size(); ++n) {
    const BeatRecord record{static_cast<std::uint32_t>(draw), run.free.taken[n], run.stalled.taken[n]};
    sink(packed(record, config, layout));
  }
}

template <class Sink>
void fragment_lines(std::size_t draw, const DrawRun& run, const Config& config, const RecordLayout& layout,
                    Sink&& sink) {
  for (std::size_t n = 0; n < run.free.fragments.size(); ++n) {
    const FragmentRecord record{static_cast<std::uint32_t>(draw), run.free.fragments[n].clock,
                                run.stalled.fragments[n].clock, run.free.fragments[n].fragment};
    sink(packed(record, config, layout));
  }
}

/// Holds the lines of a file against the expected ones.
void compare_lines(const SuiteReader& reader, const std::string& role, const RecordLayout& layout,
                   const std::vector<Record>& expected, const char* what, VerifyResult& total) {
  const std::vector<Record> given = reader.read(role, 0, reader.lines(role));
  for (std::size_t n = 0; n < std::max(given.size(), expected.size()); ++n) {
    std::string difference;
    if (n >= expected.size())
      difference = std::string("the machine has no such ") + what;
    else if (n >= given.size())
      difference = std::string("the file ends here, but the machine has another ") + what;
    else
      difference = first_difference(layout, expected[n], given[n]);
    if (difference.empty()) continue;
    if (total.mismatches++ == 0)
      total.first_difference =
          reader.place(role, std::min<std::uint64_t>(n, given.empty() ? 0 : given.size() - 1)) + ": " + difference;
  }
}

DrawRun run_draw(const MachineDraw& draw, const Config& config, std::span<const StallClock> stalls) {
  return {run_machine(draw.quads, config, draw.state, {}), run_machine(draw.quads, config, draw.state, stalls)};
}

}  // namespace

void MachineSuite::write(SuiteWriter& writer, const GenerateOptions& options) const {
  const Config& config = options.config;
  const Layouts layouts(config);
  writer.add_record("states", layouts.state);
  writer.add_record("stalls", layouts.stall);
  writer.add_record("stimulus", layouts.vertex);
  writer.add_record("beats", layouts.beat);
  writer.add_record("response", layouts.fragment);

  const std::vector<StallClock> stalls = make_stalls(options.seed, stall_clocks);
  for (const StallClock& clock : stalls) writer.write("stalls", packed(clock, config, layouts.stall));
  const std::vector<MachineDraw> draws = draws_(options);
  std::uint64_t quads = 0, fragments = 0;
  ordered_parallel(
      draws.size(), options.threads, [&](std::size_t i) { return run_draw(draws[i], config, stalls); },
      [&](std::size_t i, const DrawRun& run) {
        const MachineDraw& draw = draws[i];
        const StateRecord state{draw.state, depth_code(draw.state.znear, config), depth_code(draw.state.zfar, config)};
        writer.write("states", packed(state, config, layouts.state));
        for (const SnappedQuad& quad : draw.quads)
          for (std::size_t beat = 0; beat < 4; ++beat) {
            const VertexRecord record{static_cast<std::uint32_t>(i), beat_of(quad, beat)};
            writer.write("stimulus", packed(record, config, layouts.vertex));
          }
        beat_lines(i, run, config, layouts.beat, [&](const Record& line) { writer.write("beats", line); });
        fragment_lines(i, run, config, layouts.fragment, [&](const Record& line) { writer.write("response", line); });
        quads += draw.quads.size();
        fragments += run.free.fragments.size();
        Picture picture(draw.state, config);
        for (const TimedFragment& timed : run.free.fragments) picture.draw(timed.fragment);
        golden::save_exr(writer.add_file(picture_name(i)).string(), picture.image());
      });
  writer.set_count("vectors", fragments);
  writer.set_count("draws", draws.size());
  writer.set_count("quads", quads);
}

std::vector<MachineDraw> read_draws(const SuiteReader& reader) {
  const Config& config = reader.set().config;
  const Layouts layouts(config);
  for (const auto& [role, layout] : {std::pair<const char*, const RecordLayout*>{"states", &layouts.state},
                                     {"stalls", &layouts.stall},
                                     {"stimulus", &layouts.vertex},
                                     {"beats", &layouts.beat},
                                     {"response", &layouts.fragment}})
    require_layout(reader, role, *layout);
  const auto whole = [&](const char* role) { return reader.read(role, 0, reader.lines(role)); };
  const auto refuse = [&](const char* role, std::uint64_t line, const std::string& what) {
    throw golden::InputError(reader.place(role, line) + ": " + what);
  };

  std::vector<MachineDraw> draws;
  for (const Record& record : whole("states")) {
    const auto state = unpacked<StateRecord>(record, config);
    DrawState& s = draws.emplace_back().state = state.state;
    s.znear = std::ldexp(static_cast<double>(state.znear), -config.depth_bits);
    s.zfar = std::ldexp(static_cast<double>(state.zfar), -config.depth_bits);
    s.width = std::max(1, s.scissor_x1);  // the machine knows the scissor rectangle only
    s.height = std::max(1, s.scissor_y1);
    try {
      check_draw_state(s, config);
    } catch (const DrawStateError& error) {
      refuse("states", draws.size() - 1, error.what());
    }
  }
  std::uint64_t line = 0;
  std::uint32_t beat = 0, last_draw = 0;
  for (const Record& record : whole("stimulus")) {
    const auto [draw, given] = unpacked<VertexRecord>(record, config);
    if (draw >= draws.size() || draw < last_draw || (beat != 0 && draw != last_draw))
      refuse("stimulus", line, "beats must come in the order of the draws");
    last_draw = draw;
    std::vector<SnappedQuad>& quads = draws[draw].quads;
    if (beat == 0) quads.push_back({given.id, given.base, {}});
    if (quads.back().id != given.id || quads.back().base != given.base)
      refuse("stimulus", line, "a beat of another quad among four");
    quads.back().vertex[beat] = given.vertex;
    beat = (beat + 1) % 4;
    ++line;
  }
  if (beat != 0) refuse("stimulus", line - 1, "the last quad has no four beats");
  return draws;
}

std::vector<DrawnFragment> read_fragments(const SuiteReader& reader, std::uint64_t first, std::uint64_t count) {
  std::vector<DrawnFragment> fragments;
  for (const Record& record : reader.read("response", first, count)) {
    const auto fragment = unpacked<FragmentRecord>(record, reader.set().config);
    fragments.push_back({fragment.draw, fragment.fragment});
  }
  return fragments;
}

VerifyResult MachineSuite::verify(const SuiteReader& reader, unsigned threads) const {
  const Config& config = reader.set().config;
  const Layouts layouts(config);
  const std::vector<MachineDraw> draws = read_draws(reader);
  const auto whole = [&](const char* role) { return reader.read(role, 0, reader.lines(role)); };

  std::vector<StallClock> stalls;
  for (const Record& record : whole("stalls")) stalls.push_back(unpacked<StallClock>(record, config));
  if (std::ranges::none_of(stalls, &StallClock::offer) || std::ranges::none_of(stalls, &StallClock::ready))
    throw golden::InputError(reader.place("stalls", 0) + ": no clock offers a vertex, or none takes a fragment");

  std::vector<Record> beats, fragments;
  ordered_parallel(
      draws.size(), threads, [&](std::size_t i) { return run_draw(draws[i], config, stalls); },
      [&](std::size_t i, const DrawRun& run) {
        beat_lines(i, run, config, layouts.beat, [&](Record line) { beats.push_back(std::move(line)); });
        fragment_lines(i, run, config, layouts.fragment, [&](Record line) { fragments.push_back(std::move(line)); });
      });
  VerifyResult total;
  total.vectors = std::max<std::uint64_t>(reader.lines("response"), fragments.size());
  compare_lines(reader, "response", layouts.fragment, fragments, "fragment", total);
  compare_lines(reader, "beats", layouts.beat, beats, "beat", total);
  return total;
}

std::vector<std::string> MachineSuite::roles() const { return {"states", "stalls", "stimulus", "beats", "response"}; }

MachineDraw MachineSuite::snap_draw(const std::vector<WindowQuad>& quads, const DrawState& state,
                                    const Config& config) {
  MachineDraw draw{state, {}};
  for (const WindowQuad& quad : quads) draw.quads.push_back(snap_quad(quad, config, state));
  return draw;
}

MachineDraw MachineSuite::limited(MachineDraw draw, const GenerateOptions& options) {
  const std::size_t quads = draw.quads.size();
  const std::uint64_t fragments =
      limit_draw(draw, options.config, options.limit != 0 ? options.limit : largest_limit + 1, true);
  if (fragments == 0)
    throw golden::InputError("none of the input's quads (" + std::to_string(quads) + ") draws a fragment");
  if (options.limit == 0 && (fragments > largest_limit || draw.quads.size() < quads))
    throw golden::InputError("the input's " + std::to_string(quads) +
                             " quads are too many for a set, or draw more than " + std::to_string(largest_limit) +
                             " fragments; use --limit N or a smaller --size");
  return draw;
}

void MachineSuite::require(const SuiteReader& reader) const {
  const std::size_t draws = read_draws(reader).size();
  std::vector<std::string> pictures;
  for (std::size_t i = 0; i < draws; ++i) pictures.push_back(picture_name(i));
  require_files(reader, roles(), pictures);
  require_counts(reader,
                 {{"vectors", reader.lines("response")}, {"draws", draws}, {"quads", reader.lines("stimulus") / 4}});
}

std::string MachineSuite::picture_difference(const SuiteReader& reader) const {
  const Config& config = reader.set().config;
  const std::vector<MachineDraw> draws = read_draws(reader);
  std::vector<Picture> pictures;
  for (const MachineDraw& draw : draws) pictures.emplace_back(draw.state, config);
  std::uint64_t line = 0;
  for (const DrawnFragment& drawn : read_fragments(reader, 0, reader.lines("response"))) {
    if (drawn.draw >= draws.size() || !pictures[drawn.draw].holds(drawn.fragment))
      return reader.place("response", line) + ": a fragment outside of every picture";
    pictures[drawn.draw].draw(drawn.fragment);
    ++line;
  }
  const TemporaryFile again;
  for (std::size_t i = 0; i < draws.size(); ++i) {
    golden::save_exr(again.path, pictures[i].image());
    const std::string given = (reader.directory() / picture_name(i)).string();
    if (digest_file(again.path).sha256 == reader.manifest().at("files").at(picture_name(i)).at("sha256")) continue;
    const golden::ImageDiff diff = golden::diff_images(golden::load_exr(again.path), golden::load_exr(given),
                                                       "the picture of the fragments", given);
    for (const golden::ChannelDiff& channel : diff.channels)
      if (channel.count > 0)
        return given + ": channel " + channel.name + ": " + std::to_string(channel.count) +
               " pixels are not those of the fragments, the worst at (" + std::to_string(channel.x) + ", " +
               std::to_string(channel.y) + ")";
    return given + ": is not written as this program writes the picture of the fragments";
  }
  return {};
}

void add_machine_suites(std::vector<std::unique_ptr<Suite>>& suites) {
  const auto info = [](std::string name, std::string title) {
    return SuiteInfo{std::move(name), "machine",         std::move(title),
                     "quadrille",     latency::pipeline, "x = y = w = 0, and whatever snapping refuses"};
  };
  suites.push_back(
      std::make_unique<MachineSuite>(info("machine", "The whole machine under every draw state"), every_state));
  for (const golden::StressFamilyInfo& family : golden::stress_families())
    suites.push_back(std::make_unique<MachineSuite>(
        info("stress_" + std::string(family.name), "The whole machine: " + std::string(family.stresses)),
        [kind = family.family](const GenerateOptions& options) { return stress_draw(kind, options); }));
}

}  // namespace quadrille::vectors
