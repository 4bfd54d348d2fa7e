#include "tb/commands/cosim_report.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

namespace quadrille::tb {
namespace {

/// Each kind of line, its numbers in their places.
TEST(CosimReport, LinesShowTheirMetrics) {
  InputResult r;
  r["draws"] = 2;
  r["clears"] = 3;
  r["resets"] = 4;
  r["quads_drawn"] = 5;
  r["fragments"] = 6;
  r["cycles_rtl"] = 7;
  r["left_out"] = 8;
  r["left_out_line"] = 9;
  r["fanned_faces"] = 10;
  r["fan_primitives"] = 11;
  r["mismatches"] = 12;
  r["cycle_mismatches"] = 13;
  r["compared_bits"] = 14;
  r["eye_crossing_quads"] = 15;
  r.check.compared = 16;
  r.check.mismatches = 17;
  r.check.tolerated_depth = 18;
  r.check.tolerated_visible = 19;
  r.check.eye_crossing = 20;
  r.check.tiny = 21;
  r.check.near_edge = 22;
  r.check.tie = 23;
  r.check.coverage_flips = 24;
  CosimOptions options;
  options.common.verbose = true;
  const Config config;
  const ModelCheck model;
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* const file = open_memstream(&text, &size);
  CosimReport(options, config).print_summary(file, r, &model, false);
  std::fclose(file);
  const std::string all(text, size);
  std::free(text);
  for (const char* line :
       {"  draws          2 of one machine, each with its draw state; 3 clears, 4 resets\n",
        "  lockstep       5 quads, 6 fragments, 7 cycles\n", "                 8 quads left out: 0 without",
        " 9 on a line, ", "                 10 faces with more than four corners cut into 11 primitives\n",
        "                 12 bit mismatches, 13 cycle mismatches; 14 bits compared\n",
        "  coverage       16 fragments against the truth, 17 differ\n",
        "either being right: 18 within a depth's bound of a limit that cuts the quad,\n                 19 with the "
        "eye",
        "\n  fragments of   eye-crossing quads 20 (15 quads), under-4-px quads 21\n",
        "                 within 1/16 px of an edge 22, within 1 px of a vertex 0\n", "two edges 0, ties 23\n",
        "discarded by z 0, moved by snapping 24\n"})
    EXPECT_NE(all.find(line), all.npos) << line << "\nin\n" << all;
  EXPECT_EQ(all.find('{'), all.npos) << all;
}

TEST(CosimReport, AKeyIsOneMetric) {
  std::set<std::string> keys;
  InputResult{}.for_each_metric([&](const Metric& metric, std::uint64_t) {
    EXPECT_TRUE(keys.insert(metric.key).second) << metric.key;
    EXPECT_EQ(metric.shown.empty(), metric.line == MetricLine::none) << metric.key;
    EXPECT_FALSE(metric.unit.empty() || metric.meaning.empty()) << metric.key;
  });
}

}  // namespace
}  // namespace quadrille::tb
