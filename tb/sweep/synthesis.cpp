#include "tb/sweep/synthesis.hpp"

#include "model/support/parallel.hpp"
#include "tb/support/csv.hpp"
#include "tb/sweep/point_table.hpp"

namespace quadrille::sweep {

CostWeights weights_of(tb::SynthesisTarget target) {
  return target == tb::SynthesisTarget::ecp5 ? ecp5_weights : ecp5_nodsp_weights;
}

double measured_cost(const SynthesisRow& row) {
  return row.size.area_um2 ? *row.size.area_um2 : static_cast<double>(row.size.luts.value_or(0));
}

std::string synthesis_table(std::span<const SynthesisRow> rows) {
  std::string text =
      "row,target,luts,flip_flops,dsps,block_rams,longest_path,area_um2,nand2,mhz,critical_path,cost,cost_luts,cost_"
      "dsps\n";
  const auto count = [](const std::optional<std::uint64_t>& value) {
    return value ? std::to_string(*value) : std::string();
  };
  const auto real = [](const std::optional<double>& value) { return value ? csv_number(*value) : std::string(); };
  for (const SynthesisRow& r : rows) {
    const tb::HardwareSize& s = r.size;
    for (const std::string& cell :
         {std::to_string(r.row), std::string(tb::synthesis_target_names[static_cast<std::size_t>(r.target)]),
          count(s.luts), std::to_string(s.flip_flops), count(s.dsps), count(s.block_rams), count(s.longest_path),
          real(s.area_um2), real(s.nand2), real(s.mhz), tb::csv_cell(s.critical_path)})
      text += cell + ",";
    text += csv_number(r.cost) + "," + csv_number(r.cost_luts) + "," + std::to_string(r.cost_dsps) + "\n";
  }
  return text;
}

std::vector<SynthesisRow> synthesise(std::span<const SynthesisPoint> points, tb::SynthesisTarget target,
                                     const CostWeights& weights, unsigned threads,
                                     const std::function<void(std::size_t done, std::size_t total)>& progress) {
  std::vector<SynthesisRow> rows(points.size());
  run_units(
      points.size(), threads,
      [&](std::size_t index, unsigned) {
        const SynthesisPoint& point = points[index];
        const HardwareCost cost = hardware_cost(point.config);
        rows[index] = {.row = point.row,
                       .target = target,
                       .size = tb::synthesise_for(point.config, target),
                       .cost = scalar_cost(cost, weights),
                       .cost_luts = lut_cost(cost, weights),
                       .cost_dsps = target == tb::SynthesisTarget::ecp5 ? cost.dsps : 0};
      },
      [&, told = std::size_t{0}](std::size_t done) mutable {
        if (progress && done > told) progress(told = done, points.size());
      });
  return rows;
}

}  // namespace quadrille::sweep
