#include "golden/vectors/input_suite.hpp"

#include "golden/io/error.hpp"
#include "golden/vectors/stage_suite.hpp"
#include "model/port/boundaries.hpp"
#include "model/port/snap.hpp"

#include <algorithm>

namespace quadrille::vectors {
namespace {

SuiteInfo input_info() {
  return {std::string(input_suite_name), "machine", "The whole machine on an input of one's own", "quadrille", 26,
          "whatever snapping refuses"};
}

std::unique_ptr<const StageUnderTest> snapping(const Config& config) {
  return dynamic_cast<const StageSuite&>(find_suite("snapping")).stage(config);
}

Record pack_beat(const SnappedQuad& quad, std::size_t i, const Config& config, const RecordLayout& layout) {
  const VertexBeat beat = beat_of(quad, i);
  return pack_record(layout.bits(), [&](auto& f) { visit(beat, config, f); });
}

}  // namespace

InputSuite::InputSuite() : MachineSuite(input_info(), {}) {}

InputSuite::InputSuite(std::vector<WindowQuad> quads, const DrawState& state, const Config& config)
    : MachineSuite(input_info(),
                   [draw = snap_draw(quads, state, config)](const GenerateOptions& options) {
                     return std::vector<MachineDraw>{limited(draw, options)};
                   }),
      given_(std::move(quads)),
      state_(state) {}

std::vector<std::string> InputSuite::roles() const {
  std::vector<std::string> roles = MachineSuite::roles();
  roles.emplace_back("quads");
  return roles;
}

void InputSuite::write(SuiteWriter& writer, const GenerateOptions& options) const {
  MachineSuite::write(writer, options);
  const auto stage = snapping(options.config);
  writer.add_record("quads", stage->stimulus_layout());
  StageData data;
  data.state = state_;
  for (std::size_t n = 0; n < writer.count("quads"); ++n) {
    data.vertex = given_[n].vertex;
    for (std::size_t i = 0; i < 4; ++i) std::ranges::copy(given_[n].attribute[i], data.attribute[i].begin());
    writer.write("quads", stage->pack_stimulus(data));
  }
}

VerifyResult InputSuite::verify(const SuiteReader& reader, unsigned threads) const {
  const Config& config = reader.set().config;
  const auto stage = snapping(config);
  require_layout(reader, "quads", stage->stimulus_layout());
  if (4 * reader.lines("quads") != reader.lines("stimulus"))
    throw golden::input_error(reader.manifest_file(), 0, "stimulus has not four lines for each of quads");
  VerifyResult total = MachineSuite::verify(reader, threads);
  const RecordLayout layout = vertex_layout(config);
  const std::vector<Record> quads = reader.read("quads", 0, reader.lines("quads"));
  std::uint64_t line = 0;
  for (const MachineDraw& draw : read_draws(reader))
    for (const SnappedQuad& quad : draw.quads) {
      StageData data;
      stage->unpack_stimulus(quads[line / 4], data);
      stage->run(data);
      data.snapped.id = quad.id;
      for (std::size_t beat = 0; beat < 4; ++beat, ++line) {
        const Record given = pack_beat(quad, beat, config, layout);
        const Record expected = pack_beat(data.snapped, beat, config, layout);
        if (given != expected && total.mismatches++ == 0)
          total.first_difference = reader.place("stimulus", line) + ": " + first_difference(layout, expected, given);
      }
    }
  return total;
}

}  // namespace quadrille::vectors
