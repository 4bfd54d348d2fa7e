#include "tb/judge/verify_exact.hpp"

#include "golden/io/error.hpp"
#include "golden/vectors/machine_suite.hpp"
#include "golden/vectors/stage_suite.hpp"
#include "golden/vectors/table_suite.hpp"
#include "model/support/parallel.hpp"
#include "tb/judge/check.hpp"
#include "tb/judge/stage_judge.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace quadrille::tb {

using vectors::StageData;
using vectors::VectorOutcome;
using vectors::VerifyResult;

namespace {

VectorOutcome outcome(std::string fault) {
  if (fault.empty()) return {};
  if (fault.find("expected") == std::string::npos) fault += " is not what exact arithmetic gives";
  return {VectorOutcome::Kind::mismatch, std::move(fault)};
}

/// What the stages of one configuration are judged with.
struct Judges {
  explicit Judges(const Config& c) : config(c), pixel(c), root(sqrt_limit(c)), inverse(reciprocal_limit(c)) {}

  const Config& config;
  PixelJudge pixel;
  TableLimit root, inverse;
};

// ---- Stages: one vector, its stimulus and its response in one StageData ----

VectorOutcome snapping(const Judges& j, const StageData& d) {
  WindowQuad given;
  given.vertex = d.vertex;
  for (std::size_t i = 0; i < 4; ++i)
    given.attribute[i].assign(d.attribute[i].begin(), d.attribute[i].begin() + j.config.attribute_slots);
  const SnappingFault fault = snapping_fault(given, d.refused, d.snapped, j.config, d.state);
  if (!fault.text.empty() || !fault.undecided) return outcome(fault.text);
  return {VectorOutcome::Kind::undefined, {}};
}

VectorOutcome setup(const Judges& j, const StageData& d) {
  return outcome(d.setup.slot != 0 ? "slot" : setup_fault(d.quad, d.setup, j.config, d.state));
}

VectorOutcome tile_context(const Judges& j, const StageData& d) {
  const SeenFrom origin(d.constants.vertex, d.tile_column * j.config.tile(), d.tile_row * j.config.tile());
  return outcome(quadratic_fault(origin, d.constants.homogeneous, d.tile, j.config.qdrop()));
}

VectorOutcome coverage(const Judges& j, const StageData& d) {
  for (int row = 0; row < j.config.tile(); ++row)
    if (std::string fault =
            coverage_fault(d.tile, d.constants, row, d.row_masks[static_cast<std::size_t>(row)], j.config, d.state);
        !fault.empty())
      return outcome(std::move(fault));
  return {};
}

VectorOutcome forward_difference(const Judges&, const StageData& d) {
  return outcome(difference_fault(d.tile, d.constants, d.dx, d.row, d.pixel));
}

VectorOutcome normalise(const Judges& j, const StageData& d) { return outcome(j.pixel.normalised(d.pixel)); }

VectorOutcome sqrt(const Judges& j, const StageData& d) {
  for (std::size_t i = 0; i < 4; ++i)
    if (!is_sqrt(d.pixel.r2_fp[i], d.pixel.root[i], j.root, j.config.significand_bits))
      return outcome("sig[" + std::to_string(i) + "] or its exponent");
  return {};
}

VectorOutcome reciprocal(const Judges& j, const StageData& d) {
  return outcome(is_reciprocal(d.number, d.inverse, j.inverse, j.config.significand_bits) ? "" : "the reciprocal");
}

VectorOutcome ratios(const Judges& j, const StageData& d) { return outcome(j.pixel.ratios(d.pixel)); }

VectorOutcome weights(const Judges& j, const StageData& d) {
  // Integers with the signs that the stage looks at.
  PixelTrace t = d.pixel;
  for (std::size_t i = 0; i < 4; ++i) t.a[i] = d.a_sign[i], t.r2[i] = d.corner[i] ? 0 : 1;
  for (std::size_t k = 0; k < 6; ++k) t.d[k] = d.d_negative[k] ? -1 : 1;
  return outcome(j.pixel.weights(t, d.data));
}

VectorOutcome interpolation(const Judges& j, const StageData& d) { return outcome(j.pixel.sums(d.pixel, d.data)); }

VectorOutcome depth(const Judges& j, const StageData& d) {
  DrawState state = d.state;
  state.znear = std::ldexp(static_cast<double>(d.znear), -j.config.depth_bits);
  state.zfar = std::ldexp(static_cast<double>(d.zfar), -j.config.depth_bits);
  PixelJudge::Output expected = j.pixel.output(d.pixel, d.data, state);
  if (!expected.drawn) expected = {};  // the port shows nothing of it
  if (d.pixel.drawn != expected.drawn) return outcome("valid");
  if ((d.pixel.fragment.flags != 0) != expected.saturated) return outcome("saturated");
  return outcome(PixelJudge::values_fault(d.pixel.fragment, expected));
}

using StageJudge = VectorOutcome (*)(const Judges&, const StageData&);

constexpr std::pair<std::string_view, StageJudge> stage_judges[]{
    {"snapping", snapping},
    {"setup", setup},
    {"tile_context", tile_context},
    {"coverage", coverage},
    {"forward_difference", forward_difference},
    {"normalise", normalise},
    {"sqrt", sqrt},
    {"reciprocal", reciprocal},
    {"ratios", ratios},
    {"weights", weights},
    {"interpolation", interpolation},
    {"depth", depth},
};

// ---- The machine ----

/// One draw before the truth.
struct JudgedDraw {
  CheckResult result;
  std::optional<std::size_t> first;  ///< the first fragment that is wrong by itself
  std::string what;
};

JudgedDraw judge_draw(const vectors::MachineDraw& draw, std::vector<Fragment> fragments, const Config& config) {
  FragmentChecker::Settings settings;
  settings.config = config;
  settings.state = draw.state;
  settings.pass.columns.resize(static_cast<std::size_t>(draw.state.attributes));
  std::iota(settings.pass.columns.begin(), settings.pass.columns.end(), 4);
  settings.snapping = false;
  const auto judge = [&](std::span<const WindowQuad> names, std::span<const SnappedQuad> quads,
                         std::span<const Fragment> some, bool complete) {
    return check_here(settings, names, quads, [&](const auto& sink) {
      std::ranges::for_each(some, sink);
      return complete;
    });
  };
  // The judge numbers quads by position.
  std::vector<SnappedQuad> quads = draw.quads;
  std::vector<WindowQuad> names(quads.size());
  std::map<std::uint32_t, std::uint32_t> position;
  for (std::uint32_t n = 0; n < quads.size(); ++n) {
    if (!position.emplace(quads[n].id, n).second)
      throw std::invalid_argument("two quads of a draw have the same id, so their fragments cannot be told apart");
    names[n].id = std::exchange(quads[n].id, n);
  }
  for (Fragment& f : fragments) {
    const auto found = position.find(f.quad);
    f.quad = found == position.end() ? static_cast<std::uint32_t>(quads.size()) : found->second;
  }
  JudgedDraw out{judge(names, quads, fragments, true), {}, {}};
  out.what = out.result.first.text;
  for (std::size_t n = 0; n < fragments.size() && out.result.faults() != 0 && !out.first; ++n) {
    Fragment f = fragments[n];
    if (f.quad == quads.size()) {
      out.first = n;
      out.what = "quad: no quad of the draw";
      break;
    }
    SnappedQuad quad = quads[std::exchange(f.quad, 0)];
    const WindowQuad name = names[std::exchange(quad.id, 0)];
    const CheckResult alone = judge({&name, 1}, {&quad, 1}, {&f, 1}, false);
    if (alone.faults() == 0) continue;
    out.first = n;
    out.what = alone.first.any ? alone.first.text : "a value beyond its bound";
  }
  return out;
}

VerifyResult verify_machine(const vectors::SuiteReader& reader, unsigned threads) {
  const Config& config = reader.set().config;
  const std::vector<vectors::MachineDraw> draws = vectors::read_draws(reader);
  std::vector<std::vector<Fragment>> fragments(draws.size());
  std::vector<std::vector<std::uint64_t>> lines(draws.size() + 1);  // the last: of no draw
  std::uint64_t line = 0;
  for (const auto& [draw, fragment] : vectors::read_fragments(reader, 0, reader.lines("response"))) {
    if (draw < draws.size()) fragments[draw].push_back(fragment);
    lines[std::min<std::size_t>(draw, draws.size())].push_back(line++);
  }
  VerifyResult total;
  ordered_parallel(
      draws.size(), threads,
      [&](std::size_t d) {
        try {
          return judge_draw(draws[d], fragments[d], config);
        } catch (const std::invalid_argument& error) {
          throw golden::InputError(reader.place("stimulus", 0) + ": draw " + std::to_string(d) + ": " + error.what());
        }
      },
      [&](std::size_t d, const JudgedDraw& judged) {
        const CheckResult& result = judged.result;
        total.vectors += lines[d].size();
        // Where bits of D and R² are dropped no bound speaks of any value.
        total.undefined += config.qdrop() == 0 ? result.bound_exempt : result.compared;
        if (result.faults() != 0 && total.mismatches == 0)
          total.first_difference =
              reader.place("response", judged.first ? lines[d][*judged.first] : std::max<std::uint64_t>(line, 1) - 1) +
              ": draw " + std::to_string(d) + ", " + judged.what;
        total.mismatches += result.faults();
      });
  for (const std::uint64_t at : lines.back())
    total.add({VectorOutcome::Kind::mismatch, "draw: no such draw"}, reader, at);
  return total;
}

}  // namespace

VerifyResult verify_exact(const vectors::Suite& suite, const vectors::SuiteReader& reader, unsigned threads) {
  const Config& config = reader.set().config;
  if (const auto* tables = dynamic_cast<const vectors::TableSuite*>(&suite)) {
    vectors::require_layout(reader, "stimulus", tables->stimulus_layout(config));
    vectors::require_layout(reader, "response", tables->response_layout(config));
    return vectors::check_vectors(reader, threads, [&](const Record& index, const Record& response) {
      return outcome(table_fault(suite.info().name == "sqrt_table", config, index.get(0, index.bits()),
                                 tables->entry(response, config)));
    });
  }
  if (dynamic_cast<const vectors::MachineSuite*>(&suite) != nullptr) return verify_machine(reader, threads);
  const auto* stages = dynamic_cast<const vectors::StageSuite*>(&suite);
  const auto judge =
      std::ranges::find(stage_judges, suite.info().name, &std::pair<std::string_view, StageJudge>::first);
  if (stages == nullptr || judge == std::end(stage_judges))
    throw golden::InputError("suite " + suite.info().name + ": the engine float cannot judge it");
  return stages->check(reader, threads,
                       [&, judges = Judges(config)](const vectors::StageUnderTest& stage, const Record& stimulus,
                                                    const Record& response) {
                         StageData data;
                         stage.unpack_stimulus(stimulus, data);
                         stage.unpack_response(response, data);
                         return judge->second(judges, data);
                       });
}

}  // namespace quadrille::tb
