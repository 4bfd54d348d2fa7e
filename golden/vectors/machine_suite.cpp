#include "golden/vectors/machine_suite.hpp"

#include "golden/io/error.hpp"
#include "golden/io/exr.hpp"
#include "golden/io/image_diff.hpp"
#include "golden/vectors/machine_records.hpp"
#include "model/support/parallel.hpp"

#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <string>

namespace quadrille::vectors {
namespace {

constexpr std::size_t stall_clocks = 1024;

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
      draws.size(), options.threads,
      [&](std::size_t i) { return run_both(draws[i].quads, config, draws[i].state, stalls); },
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
      draws.size(), threads, [&](std::size_t i) { return run_both(draws[i].quads, config, draws[i].state, stalls); },
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
    if (digest_file(again.path).sha256 ==
        reader.manifest().at("files").at(picture_name(i)).at("sha256").get<std::string>())
      continue;
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

}  // namespace quadrille::vectors
