#include "tb/sweep/synthesis.hpp"

#include "model/support/parallel.hpp"
#include "tb/yosys/yosys.hpp"

namespace quadrille::sweep {

std::vector<SynthesisRow> synthesise(std::span<const SynthesisPoint> points, const CostWeights& weights,
                                     unsigned threads,
                                     const std::function<void(std::size_t done, std::size_t total)>& progress) {
  std::vector<SynthesisRow> rows(points.size());
  run_units(
      points.size(), threads,
      [&](std::size_t index, unsigned) {
        const SynthesisPoint& point = points[index];
        const tb::FpgaReport report = tb::synthesise_fpga(point.config);
        rows[index] = {.row = point.row,
                       .luts = report.luts,
                       .flip_flops = report.flip_flops,
                       .dsps = report.dsps,
                       .longest_path = report.longest_path,
                       .cost = scalar_cost(hardware_cost(point.config), weights)};
      },
      [&, told = std::size_t{0}](std::size_t done) mutable {
        if (progress && done > told) progress(told = done, points.size());
      });
  return rows;
}

}  // namespace quadrille::sweep
