// The search finds what is put there to be found, which as many quads at random do not, and stays within its family.
#include "tb/judge/family_search.hpp"

#include "model/support/prng.hpp"
#include "tb/judge/climb.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace quadrille::tb {
namespace {

FamilySearch search_of(golden::StressFamily family, Output output, std::uint64_t evaluations, std::uint64_t seed) {
  FamilySearch search;
  search.family = family;
  search.output = output;
  search.evaluations = evaluations;
  search.seed = seed;
  return search;
}

/// The largest of so many evaluations at pixels of quads as the family draws them.
template <class Measure>
double best_at_random(const FamilySearch& search, Measure measure) {
  golden::Prng rng(search.seed, 99);
  const std::vector<WindowQuad> quads =
      golden::make_stress(search.family, search.evaluations, search.seed, 1.0, search.width, search.height, 5);
  double best = -1;
  for (const WindowQuad& quad : quads) {
    FamilyCandidate c;
    c.quad = quad;
    for (std::vector<double>& attribute : c.quad.attribute) attribute = {attribute[4]};
    c.at = PixelBox(quad, search.width, search.height).pick(rng);
    best = std::max(best, measure(c));
  }
  return best;
}

/// A fault that a judge sees at one pixel alone, of quads with a corner at one place, and more of it the nearer they
/// are.
double planted(const FamilyCandidate& c) {
  const WindowVertex& v = c.quad.vertex[0];
  const double corner = std::hypot(v.x / v.w - 20.3, v.y / v.w - 41.7);
  const double pixel = std::hypot(c.at.x - 50, c.at.y - 9);
  return 8 / (1 + corner + pixel);
}

TEST(FamilySearch, FindsAPlantedFault) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const FamilySearch search = search_of(golden::StressFamily::general, Output::weight, 6'000, seed);
    const std::vector<FamilySummit> found = search_family(search, planted);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].candidate.at.x, 50);
    EXPECT_EQ(found[0].candidate.at.y, 9);
    EXPECT_GT(found[0].units, 0.9 * 8) << "seed " << seed;
    EXPECT_EQ(found[0].units, planted(found[0].candidate));
    EXPECT_LT(best_at_random(search, planted), 0.5 * 8) << "or it was no search";
    EXPECT_TRUE(std::ranges::is_sorted(found, std::ranges::greater(), &FamilySummit::units));
  }
}

TEST(FamilySearch, StaysWithinTheFamilyAndTheEvaluations) {
  std::uint64_t seen = 0, outside = 0, knobs = 0;
  const auto centre = [](double p) { return p - std::floor(p) == 0.5; };
  const FamilySearch search = search_of(golden::StressFamily::on_vertex, Output::depth, 3'001, 4);
  search_family(search, [&](const FamilyCandidate& c) {
    ++seen;
    for (const WindowVertex& v : c.quad.vertex) outside += !centre(v.x / v.w) || !centre(v.y / v.w);
    outside += c.at.x < 0 || c.at.x >= 64 || c.at.y < 0 || c.at.y >= 64;
    knobs += c.drawing.knob != 1;
    for (const std::vector<double>& a : c.quad.attribute) outside += a.size() != 1 || std::fabs(a[0]) > 1;
    return static_cast<double>(seen % 1000);
  });
  EXPECT_EQ(seen, 3'001u);
  EXPECT_EQ(outside, 0u);
  EXPECT_GT(knobs, 100u);
}

TEST(FamilySearch, LeavesTheFamilyWhenTold) {
  const auto centre = [](double p) { return p - std::floor(p) == 0.5; };
  for (const Output output : {Output::weight, Output::attribute, Output::depth}) {
    FamilySearch search = search_of(golden::StressFamily::on_vertex, output, 3'000, 4);
    search.leave = true;
    std::uint64_t seen = 0, drawn_off = 0, moved_off = 0, beyond = 0;
    search_family(search, [&](const FamilyCandidate& c) {
      const bool off = std::ranges::any_of(
          c.quad.vertex, [&](const WindowVertex& v) { return !centre(v.x / v.w) || !centre(v.y / v.w); });
      // An eighth is drawn by the family, the rest climbs.
      (++seen <= 3'000 / 8 ? drawn_off : moved_off) += off;
      beyond += c.at.x < 0 || c.at.x >= 64 || c.at.y < 0 || c.at.y >= 64;
      for (const std::vector<double>& a : c.quad.attribute) beyond += a.size() != 1 || std::fabs(a[0]) > 1;
      return static_cast<double>(seen % 1000);
    });
    EXPECT_EQ(seen, 3'000u);
    EXPECT_EQ(drawn_off, 0u);
    EXPECT_GT(moved_off, 1'000u);
    EXPECT_EQ(beyond, 0u);
  }
}

TEST(FamilySearch, FollowsFromItsArguments) {
  const auto fingerprint = [](golden::StressFamily family, Output output, std::uint64_t seed) {
    double sum = 0;
    for (const FamilySummit& summit : search_family(search_of(family, output, 600, seed)))
      sum = sum * 3 + summit.units + summit.candidate.quad.vertex[1].x;
    return sum;
  };
  using golden::StressFamily;
  const double first = fingerprint(StressFamily::reflex, Output::weight, 1);
  EXPECT_EQ(first, fingerprint(StressFamily::reflex, Output::weight, 1));
  EXPECT_NE(first, fingerprint(StressFamily::reflex, Output::weight, 2));
  EXPECT_NE(first, fingerprint(StressFamily::reflex, Output::depth, 1));
  EXPECT_NE(first, fingerprint(StressFamily::bowtie, Output::weight, 1));
}

TEST(FamilySearch, FindsNothingWhereNothingIsDrawn) {
  EXPECT_TRUE(search_family(search_of(golden::StressFamily::tiny, Output::weight, 500, 1), [](const FamilyCandidate&) {
                return -1.0;
              }).empty());
}

/// Over all families the search's worst are larger than those of as many pixels at random; and what it climbs on is
/// what the untimed model and the truth say of its summits.
TEST(FamilySearch, IsWorthMoreThanChance) {
  for (const Output output : {Output::weight, Output::attribute, Output::depth}) {
    double by_search = 0, by_chance = 0;
    int better = 0;
    for (const golden::StressFamilyInfo& info : golden::stress_families()) {
      const FamilySearch search = search_of(info.family, output, 3'000, 5);
      PixelErrors errors(search.config, search_state(search.width, search.height), output);
      const auto measure = [&](const FamilyCandidate& c) {
        return errors.measure(quad_for(c.quad, output), c.at.x, c.at.y);
      };
      const std::vector<FamilySummit> found = search_family(search, measure);
      ASSERT_FALSE(found.empty()) << info.name;
      for (const FamilySummit& summit : found) {
        const FamilyCandidate& c = summit.candidate;
        EXPECT_NEAR(errors.judge(quad_for(c.quad, output), c.at.x, c.at.y).units, summit.units, 1e-6) << info.name;
      }
      const double random = std::max(0.0, best_at_random(search, measure));
      better += found[0].units > random;
      by_search += found[0].units;
      by_chance += random;
    }
    EXPECT_GT(by_search, by_chance) << output_names[static_cast<std::size_t>(output)];
    // If both were as good, 18 of 22 or more would have a probability of 0.2 %.
    EXPECT_GE(better, 18) << "of 22 families, " << output_names[static_cast<std::size_t>(output)];
    RecordProperty(std::string(output_names[static_cast<std::size_t>(output)]) + "_over_chance",
                   std::to_string(by_search / by_chance));
  }
}

}  // namespace
}  // namespace quadrille::tb
