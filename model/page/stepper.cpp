#include "model/page/stepper.hpp"

#include "model/support/json.hpp"

namespace quadrille::page {
namespace {

constexpr std::array<std::string_view, 7> stage_names{"diff", "norm", "sqrt", "ratio", "weight", "sum", "fragment"};

}  // namespace

Stepper::Stepper(const Drawing& drawing)
    : config_(drawing.request.config),
      bare_(bare_quads(drawing)),
      model_(config_, bare_.state, Probes::all),
      prng_(1),
      ring_(static_cast<std::size_t>(ring_entries(config_))) {
  ClockedInputs reset;
  reset.reset = true;
  model_.clock(reset);
  while (model_.comb().busy) model_.clock({});
}

void Stepper::run(int clocks, int stall) {
  for (int i = 0; i < clocks && !done_; ++i) clock(static_cast<int>(prng_.below(100)) >= stall);
}

void Stepper::clock(bool ready) {
  const ClockedOutputs outputs = model_.comb();
  ClockedInputs inputs;
  inputs.vertex_valid = beats_ < 4 * bare_.quads.size();
  inputs.fragment_ready = ready;
  if (inputs.vertex_valid) inputs.vertex = beat_of(bare_.quads[beats_ / 4], beats_ % 4);
  vertex_taken_ = inputs.vertex_valid && outputs.vertex_ready;
  stalls_ = outputs.fragment_valid && !ready;
  look(outputs);
  if (outputs.fragment_valid && ready)
    outputs.for_each_fragment([&](const Fragment& f) {
      left_.push_back(static_cast<std::uint32_t>(f.x) | static_cast<std::uint32_t>(f.y) << 16);
      ++fragments_;
    });
  const PerformanceCounters before = model_.counters();
  model_.clock(inputs);
  const PerformanceCounters after = model_.counters();
  bound_.clear();
  for (std::size_t i = 0; i < counter_count; ++i)
    if (counter_info[i].name.starts_with("bound_") && after.value[i] != before.value[i])
      bound_ = counter_info[i].name.substr(6);
  beats_ += vertex_taken_ ? 1 : 0;
  stalled_ += stalls_ ? 1 : 0;
  ++clocks_;
  done_ = beats_ == 4 * bare_.quads.size() && !model_.comb().busy;
}

void Stepper::look(const ClockedOutputs& outputs) {
  const ClockedProbes& probes = outputs.probes;
  setup_ = probes.setup != nullptr;
  setup_quad_ = probes.setup_quad;
  tile_ = stamp_ = {};
  stamp_mask_ = 0;
  if (probes.tile != nullptr) {
    const Tile tile{probes.tile->tile_x * config_.tile(), probes.tile->tile_y * config_.tile()};
    ring_[tiles_++ % ring_.size()] = tile;
    tile_ = {true, tile.x, tile.y};
  }
  if (probes.stamp != nullptr) {
    const Tile& tile = ring_[probes.stamp->tile_ptr % ring_.size()];
    stamp_ = {true, tile.x, tile.y + probes.stamp->row};
    stamp_mask_ = probes.stamp->mask;
  }
  for (auto& stage : lanes_) stage.clear();
  for (int lane = 0; probes.lane != nullptr && lane < config_.pixels_per_clock; ++lane) {
    const LaneProbes& of = probes.lane[lane];
    const std::array<const PixelTrace*, 6> traces{of.diff, of.norm, of.sqrt, of.ratio, of.weight, of.sum};
    for (std::size_t stage = 0; stage < traces.size(); ++stage)
      if (traces[stage] != nullptr) lanes_[stage].push_back({true, traces[stage]->x, traces[stage]->y});
  }
  if (outputs.fragment_valid)
    outputs.for_each_fragment([&](const Fragment& f) { lanes_[6].push_back({true, f.x, f.y}); });
}

std::string Stepper::json() const {
  const auto place = [](const Place& p) {
    return p.any ? "[" + std::to_string(p.x) + "," + std::to_string(p.y) + "]" : std::string("null");
  };
  Json pixels;
  for (std::size_t stage = 0; stage < stage_names.size(); ++stage)
    pixels.raw(stage_names[stage], Json::list(lanes_[stage], place));
  return Json()
      .put("clock", clocks_)
      .put("done", done_)
      .put("bound", bound_)
      .put("vertices", beats_)
      .put("vertex_taken", vertex_taken_)
      .raw("setup", setup_ ? std::to_string(setup_quad_) : "null")
      .raw("tile", place(tile_))
      .put("tile_size", config_.tile())
      .put("tiles", tiles_)
      .raw("stamp", place(stamp_))
      .put("stamp_mask", stamp_mask_)
      .raw("pixels", pixels.text())
      .put("stalls", stalls_)
      .put("stalled", stalled_)
      .put("fragments", fragments_)
      .text();
}

}  // namespace quadrille::page
