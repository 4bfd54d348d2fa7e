#include "tb/triangles/machine.hpp"

#include "model/drive.hpp"
#include "model/port/bit_vector.hpp"
#include "model/port/stages.hpp"
#include "model/support/prng.hpp"
#include "tb/device/verilated_device.hpp"
#include "tb/lockstep/driven_device.hpp"

#include <cstring>
#include <utility>

namespace quadrille::tb {
namespace {

constexpr std::size_t beats = 3;
constexpr std::uint64_t silent_limit = 1'000'000;  ///< clocks in which nothing moves

class TriangleStimulus {
 public:
  TriangleStimulus(std::span<const SnappedTriangle> triangles, const Config& config, const TriangleWaits& waits)
      : triangles_(triangles),
        config_(config),
        waits_(waits),
        random_(waits.seed),
        width_(vertex_layout(config).bits()),
        packed_(static_cast<std::size_t>((width_ + 63) / 64)),
        words_(words_for(width_)) {
    offer();
  }

  bool done() const { return next_ == beats * triangles_.size(); }
  bool valid() const { return valid_; }
  bool ready() const { return ready_; }
  std::span<const std::uint32_t> words() const { return words_; }

  void advance(bool taken) {
    next_ += taken ? 1 : 0;
    ready_ = waits_.stall == 0 || !random_.chance(waits_.stall);
    if (taken || !valid_) offer();
  }

 private:
  void offer() {
    valid_ = !done() && (waits_.gap == 0 || !random_.chance(waits_.gap));
    if (!valid_) return;
    BitPacker packer(packed_.data(), width_);
    visit(std::as_const(beat_ = beat_of(triangles_[next_ / beats], next_ % beats)), config_, packer);
    packer.finish();
    std::memcpy(words_.data(), packed_.data(), words_.size() * sizeof words_[0]);
  }

  std::span<const SnappedTriangle> triangles_;
  const Config& config_;
  TriangleWaits waits_;
  golden::Prng random_;
  int width_;
  std::vector<std::uint64_t> packed_;
  std::vector<std::uint32_t> words_;
  std::size_t next_ = 0;
  bool valid_ = false, ready_ = true;
  VertexBeat beat_;
};

struct DrivenTriangles {
  Device& device;

  const DeviceSample& settle(const TriangleStimulus& stimulus) {
    device.set_vertex(stimulus.words());
    device.set_handshake(stimulus.valid(), stimulus.ready());
    device.settle();
    return device.sample();
  }
  void clock() { device.clock(); }
};

VerilateOptions options_of(const std::filesystem::path& folder) {
  VerilateOptions options;
  options.probes = false;
  options.source = folder;
  return options;
}

}  // namespace

std::vector<WindowQuad> split_quads(std::span<const WindowQuad> quads) {
  std::vector<WindowQuad> triangles;
  for (const WindowQuad& quad : quads) {
    for (const std::array<std::size_t, 4>& corners : {std::array<std::size_t, 4>{0, 1, 2, 2}, {0, 2, 3, 3}}) {
      WindowQuad& triangle = triangles.emplace_back();
      triangle.id = static_cast<std::uint32_t>(triangles.size() - 1);
      for (std::size_t i = 0; i < 4; ++i) {
        triangle.vertex[i] = quad.vertex[corners[i]];
        triangle.attribute[i] = quad.attribute[corners[i]];
      }
    }
  }
  return triangles;
}

TriangleMachine::TriangleMachine(const Config& config, const std::filesystem::path& folder)
    : config_(config), simulator_(verilate(config, options_of(folder))) {}

TriangleRun TriangleMachine::draw(std::span<const SnappedTriangle> triangles, const DrawState& state,
                                  const FragmentSink& sink, const TriangleWaits& waits) const {
  VerilatedDevice device(simulator_, config_, waits.seed);
  LockstepOptions reset;  // what a reset needs
  reset.config = config_;
  reset.state = state;
  DrivenDevice(device, reset);
  TriangleStimulus stimulus(triangles, config_, waits);
  FragmentMonitor monitor(config_, boundary_layout(Boundary::fragment, config_).bits(), sink);
  DrivenTriangles machine{device};
  std::uint64_t silent = 0;
  TriangleRun run;
  run.clocks = drive(machine, stimulus, [&](std::uint64_t, const DeviceSample& out, bool taken) {
    const bool moved = out.fragment_valid && stimulus.ready();
    for (std::size_t lane = 0; moved && lane < most_lanes; ++lane)
      if ((out.fragment_mask >> lane & 1) != 0) monitor.handed_over(out.fragment[lane], nullptr);
    silent = taken || moved ? 0 : silent + 1;
    if (silent > silent_limit) throw DeviceError("the triangle machine hangs");
    return !stimulus.done() || out.busy;
  });
  if (config_.performance_counters != 0)
    for (std::size_t i = 0; i < counter_count; ++i) run.counters.value[i] = device.counter(i);
  return run;
}

}  // namespace quadrille::tb
