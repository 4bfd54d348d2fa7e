// The clocked model as a device, which tests may spoil: no Verilator needed, and the place of a fault is known.
#pragma once

#include "model/clocked.hpp"
#include "model/port/bit_vector.hpp"
#include "model/port/stages.hpp"
#include "tb/device/device.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace quadrille::tb {

/// The clocked model behind the pins of a device. `fault` may spoil the outputs of a clock.
class ModelDevice : public Device {
 public:
  struct Outputs {
    ClockedOutputs model;
    DeviceSample sample;
    bool ready = false;  ///< of the fragment port, in this clock
    std::array<std::array<std::vector<std::uint32_t>, most_lanes>, probe_count + 1> words;  ///< by boundary and lane
  };
  using Fault = std::function<void(std::uint64_t cycle, Outputs&)>;

  ModelDevice(const Config& config, const DrawState& state, Fault fault = {})
      : config_(config), model_(config, state, Probes::all), vertex_(vertex_layout(config)), fault_(std::move(fault)) {
    for (std::size_t i = 0; i <= probe_count; ++i)
      layouts_.push_back(boundary_layout(static_cast<Boundary>(i), config));
  }

  void set_reset(bool active) override { inputs_.reset = active; }
  void set_state(std::span<const std::uint32_t> words) override {
    for (const DrawState& state : states)
      if (std::ranges::equal(pack_state(state, config_), words)) model_.set_state(state);
  }
  void set_vertex(std::span<const std::uint32_t> words) override {
    visit(inputs_.vertex, config_, RecordUnpacker(Record::from_words(words.data(), vertex_.bits())));
  }
  void set_clear_hidden(bool active) override { inputs_.clear_hidden = active && takes_clears; }
  void set_flush(bool active) override { inputs_.flush = active && !ignores_flush; }
  void set_handshake(bool vertex_valid, bool fragment_ready) override {
    inputs_.vertex_valid = vertex_valid;
    inputs_.fragment_ready = fragment_ready;
  }
  void settle() override {
    out_.model = model_.comb();
    const ClockedProbes& p = out_.model.probes;
    for (ProbeSample& probe : out_.sample.probe) probe.valid = 0;
    const auto fill = [&](Boundary b, std::size_t lane, const auto* record, auto&& pack) {
      const auto i = static_cast<std::size_t>(b);
      std::vector<std::uint64_t> wide(static_cast<std::size_t>(layouts_[i].bits() + 63) / 64);
      if (record != nullptr) {
        BitPacker packer(wide.data(), layouts_[i].bits());
        pack(*record, packer);
        packer.finish();
      }
      std::vector<std::uint32_t>& words = out_.words[i][lane];
      words.resize(words_for(layouts_[i].bits()));
      std::memcpy(words.data(), wide.data(), words.size() * 4);
      if (i == probe_count) {
        out_.sample.fragment[lane] = words.data();
      } else {
        out_.sample.probe[i].valid |= (record != nullptr ? 1u : 0u) << lane;
        out_.sample.probe[i].words[lane] = words.data();
      }
    };
    const auto plain = [&](const auto& r, BitPacker& packer) { visit(r, config_, packer); };
    fill(Boundary::setup, 0, p.setup, plain);
    fill(Boundary::tile, 0, p.tile, plain);
    fill(Boundary::stamp, 0, p.stamp, plain);
    for (std::size_t lane = 0; lane < static_cast<std::size_t>(config_.pixels_per_clock); ++lane) {
      const auto pixel = [&](Boundary b, const PixelTrace* t) {
        fill(b, lane, t, [&](const PixelTrace& r, BitPacker& packer) { visit(r, b, config_, packer); });
      };
      pixel(Boundary::diff, p.lane[lane].diff);
      pixel(Boundary::norm, p.lane[lane].norm);
      pixel(Boundary::sqrt, p.lane[lane].sqrt);
      pixel(Boundary::ratio, p.lane[lane].ratio);
      pixel(Boundary::weight, p.lane[lane].weight);
      pixel(Boundary::sum, p.lane[lane].sum);
      fill(Boundary::fragment, lane, out_.model.fragment[lane], plain);
    }
    out_.sample.vertex_ready = out_.model.vertex_ready;
    out_.sample.fragment_valid = out_.model.fragment_valid;
    out_.sample.busy = out_.model.busy;
    out_.sample.fragment_mask = out_.model.fragment_mask();
    out_.ready = inputs_.fragment_ready;
    if (fault_ && !inputs_.reset) fault_(cycle_, out_);
  }
  const DeviceSample& sample() override { return out_.sample; }
  void clock() override {
    if (!inputs_.reset && cycle_ == stops_at_edge) throw DeviceError("at its edge");
    model_.clock(inputs_);
    if (!inputs_.reset) ++cycle_;
  }
  std::uint32_t counter(std::size_t index) override {
    if (index >= counter_count) return 0;
    return static_cast<std::uint32_t>(model_.counters().value[index]) + (index == wrong_counter ? 1 : 0);
  }
  std::size_t wrong_counter = counter_count;  ///< one too many
  std::uint64_t stops_at_edge = ~std::uint64_t{0};
  std::vector<DrawState> states;  ///< that it knows by their bits; another changes nothing
  bool takes_clears = true, ignores_flush = false;

 private:
  Config config_;
  ClockedModel model_;
  RecordLayout vertex_;
  std::vector<RecordLayout> layouts_;
  Fault fault_;
  ClockedInputs inputs_;
  Outputs out_;
  std::uint64_t cycle_ = 0;
};

}  // namespace quadrille::tb
