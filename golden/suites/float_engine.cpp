#include "golden/suites/float_engine.hpp"

#include "golden/io/error.hpp"
#include "golden/suites/float_judge.hpp"
#include "golden/suites/float_quad.hpp"
#include "golden/suites/float_stages.hpp"
#include "golden/suites/machine_suite.hpp"
#include "golden/suites/stage_suite.hpp"
#include "golden/suites/table_suite.hpp"
#include "model/support/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

namespace quadrille::vectors {
namespace {

/// Relative error of a segment's polynomial (floating::Losses), at places from one end of it to the other.
VectorOutcome check_table(bool sqrt, const floating::Losses& l, const Table& table, const Record& stimulus,
                          const TableEntry& entry) {
  using floating::Real;
  floating::Judge judge;
  const std::uint64_t index = stimulus.get(0, stimulus.bits()), segments = std::uint64_t{1} << table.segments_log2;
  const int octave = index >= segments ? 1 : 0;
  for (int part = 0; part <= 8; ++part) {
    const Real u = ldexpl(static_cast<Real>(part), -3);
    const Real x = ldexpl(1 + (static_cast<Real>(index % segments) + u) / static_cast<Real>(segments), octave);
    const Real rise = (static_cast<Real>(entry.c1) - static_cast<Real>(entry.c2) * u) * u;
    const Real y = ldexpl(static_cast<Real>(entry.c0) + (sqrt ? rise : -rise), -(l.s + Config::table_guard));
    const Real exact = sqrt ? sqrtl(x) / 2 : 1 / x, tolerance = (sqrt ? l.sqrt : l.reciprocal) * exact;
    judge.within("c0", -1, y, exact - tolerance, exact + tolerance);
  }
  return judge.outcome();
}

/// Pixels that a quad must draw and does not, or draws twice, count as further vectors.
void check_complete(VerifyResult& total, const SuiteReader& reader, const std::vector<MachineDraw>& draws,
                    unsigned threads) {
  const std::uint64_t lines = reader.lines("response");
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> pixels;
  for (const DrawnFragment& drawn : read_fragments(reader, 0, lines))
    pixels[{drawn.draw, drawn.fragment.quad}].push_back(std::uint32_t{drawn.fragment.y} << 16 | drawn.fragment.x);
  for (auto& [quad, list] : pixels) std::ranges::sort(list);

  struct Missing {
    std::uint64_t count = 0;
    std::string first;
  };
  const auto one_draw = [&](std::size_t d) {
    const DrawState& state = draws[d].state;
    Missing missing;
    const auto add = [&](const SnappedQuad& quad, int x, int y, const char* what) {
      if (missing.count++ == 0)
        missing.first = std::string(what) + " of quad " + std::to_string(quad.id) + " of draw " + std::to_string(d) +
                        " at (" + std::to_string(x) + ", " + std::to_string(y) + ")";
    };
    for (const SnappedQuad& quad : draws[d].quads) {
      const FloatQuad real(quad, reader.set().config, state);
      const auto found = pixels.find({static_cast<std::uint32_t>(d), quad.id});
      const std::vector<std::uint32_t> none, &list = found == pixels.end() ? none : found->second;
      for (auto same = std::ranges::adjacent_find(list); same != list.end();
           same = std::adjacent_find(same + 1, list.end()))
        add(quad, static_cast<int>(*same & 0xffff), static_cast<int>(*same >> 16), "a second fragment");
      for (int y = real.rows().bounds().y0; y < real.rows().bounds().y1; ++y) {
        const golden::PixelSpan row = real.rows().row(y);
        for (int x = row.x0; x < row.x1; ++x)
          if (real.must_draw(x, y) &&
              !std::ranges::binary_search(list, static_cast<std::uint32_t>(y) << 16 | static_cast<std::uint32_t>(x)))
            add(quad, x, y, "no fragment");
      }
    }
    return missing;
  };
  ordered_parallel(draws.size(), threads, one_draw, [&](std::size_t, const Missing& missing) {
    if (missing.count > 0 && total.mismatches == 0)
      total.first_difference = reader.place("response", std::max<std::uint64_t>(lines, 1) - 1) + ": " + missing.first;
    total.vectors += missing.count;
    total.mismatches += missing.count;
  });
}

VerifyResult verify_machine(const SuiteReader& reader, unsigned threads) {
  const Config& config = reader.set().config;
  const std::vector<MachineDraw> draws = read_draws(reader);
  std::vector<std::map<std::uint32_t, std::size_t>> quad_of_id(draws.size());
  for (std::size_t d = 0; d < draws.size(); ++d)
    for (std::size_t q = 0; q < draws[d].quads.size(); ++q)
      if (!quad_of_id[d].emplace(draws[d].quads[q].id, q).second)
        throw golden::InputError(reader.place("stimulus", 0) +
                                 ": two quads of a draw have the same id, so their fragments cannot be told apart");

  constexpr std::uint64_t chunk = 1024;
  const std::uint64_t lines = reader.lines("response");
  VerifyResult total;
  ordered_parallel((lines + chunk - 1) / chunk, threads,
                   [&](std::size_t unit) {
                     const std::uint64_t first = unit * chunk;
                     VerifyResult part;
                     std::optional<FloatQuad> quad;
                     std::pair<std::uint32_t, std::uint32_t> current{};
                     std::uint64_t line = first;
                     for (const DrawnFragment& drawn : read_fragments(reader, first, std::min(chunk, lines - first))) {
                       VectorOutcome outcome{VectorOutcome::Kind::mismatch, "draw: no such draw"};
                       if (drawn.draw < draws.size()) {
                         const MachineDraw& draw = draws[drawn.draw];
                         const auto found = quad_of_id[drawn.draw].find(drawn.fragment.quad);
                         outcome.difference = "quad: no quad of the draw";
                         if (found != quad_of_id[drawn.draw].end()) {
                           if (!quad || current != std::pair{drawn.draw, drawn.fragment.quad})
                             quad.emplace(draw.quads[found->second], config, draw.state);
                           current = {drawn.draw, drawn.fragment.quad};
                           outcome = quad->check(drawn.fragment);
                         }
                       }
                       part.add(outcome, reader, line++);
                     }
                     return part;
                   },
                   [&](std::size_t, const VerifyResult& part) { total.merge(part); });
  check_complete(total, reader, draws, threads);
  return total;
}

}  // namespace

VerifyResult verify_float(const Suite& suite, const SuiteReader& reader, unsigned threads) {
  if (const auto* tables = dynamic_cast<const TableSuite*>(&suite)) {
    const Config& config = reader.set().config;
    require_layout(reader, "stimulus", tables->stimulus_layout(config));
    require_layout(reader, "response", tables->response_layout(config));
    return check_vectors(reader, threads,
                         [&, losses = floating::Losses(config), table = tables->table(config)](const Record& stimulus,
                                                                                               const Record& response) {
                           return check_table(suite.info().name == "sqrt_table", losses, table, stimulus,
                                              tables->entry(response, config));
                         });
  }
  const auto* stages = dynamic_cast<const StageSuite*>(&suite);
  if (stages == nullptr) return verify_machine(reader, threads);
  const auto stage = stages->stage(reader.set().config);
  require_layout(reader, "stimulus", stage->stimulus_layout());
  require_layout(reader, "response", stage->response_layout());
  const FloatStage real(suite.info().name, *stage);
  return check_vectors(reader, threads,
                       [&](const Record& stimulus, const Record& response) { return real.check(stimulus, response); });
}

}  // namespace quadrille::vectors
