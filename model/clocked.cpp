#include "model/clocked.hpp"

#include "model/latency.hpp"
#include "model/pixel_pipeline.hpp"
#include "model/quad_setup.hpp"
#include "model/stamp_coverage.hpp"

#include <bit>
#include <deque>
#include <vector>

namespace quadrille {
namespace {

constexpr int last_stage = latency::fragment_stage;

/// First-in first-out ring with a registered count, as the RTL's.
template <class T>
class Fifo {
 public:
  explicit Fifo(std::size_t capacity) : slots_(capacity) {}
  bool empty() const { return count_ == 0; }
  bool full() const { return count_ == slots_.size(); }
  const T& head() const { return slots_[first_]; }
  void pop() {
    first_ = (first_ + 1) % slots_.size();
    --count_;
  }
  void push(const T& v) {
    slots_[(first_ + count_) % slots_.size()] = v;
    ++count_;
  }
  void clear() { first_ = count_ = 0; }

 private:
  std::vector<T> slots_;
  std::size_t first_ = 0, count_ = 0;
};

/// vertex_assembly: four beats make a quad.
struct VertexAssembly {
  SnappedQuad quad;
  int count = 0;
  bool full = false;
};

/// The control half of quad_setup; the bits come from the function of that name at start.
struct SetupUnit {
  bool busy = false;  ///< PREP, RUN, DRAIN or DONE
  int remaining = 0;  ///< clocks before DONE
  SetupResult result;

  bool done() const { return busy && remaining == 0; }
};

/// What a slot of the bank holds: the back half's data and the front half's constants.
struct Slot {
  QuadData data;
  QuadConstants constants;
};

}  // namespace

struct ClockedModel::Impl {
  PipelineContext context;
  VertexAssembly assembly;
  SetupUnit setup;
  std::vector<Slot> slots;
  std::uint32_t alloc = 0, in_use = 0;
  TileWalk walk;
  std::vector<TileEntry> ring;
  std::uint32_t ring_write = 0, ring_stamp = 0, ring_mask;
  int stamp_row = 0;
  Fifo<StampEntry> fifo;
  std::uint32_t rest = 0;  ///< bits of the head's mask still to be emitted; valid when !first
  bool first = true;
  std::array<PixelTrace, last_stage + 1> pipeline{};  ///< a delay line: register n is pipeline[(head + n) % size]
  std::size_t head = 0;

  Impl(const Config& config, const DrawState& state)
      : context(config, state),
        slots(static_cast<std::size_t>(config.quad_slots())),
        walk(config, state),
        ring(static_cast<std::size_t>(config.tile_slots())),
        ring_mask(static_cast<std::uint32_t>(2 * config.tile_slots() - 1)),
        fifo(static_cast<std::size_t>(config.stamp_fifo())) {}

  const PixelTrace& stage(int n) const { return pipeline[(head + static_cast<std::size_t>(n)) % pipeline.size()]; }

  // Conditions of this clock, from registered state.
  bool start() const { return assembly.full && !setup.busy && in_use < slots.size(); }
  bool take() const { return setup.done() && walk.state() == TileWalk::State::idle; }
  std::uint32_t ring_tail() const { return fifo.empty() ? ring_stamp : fifo.head().tile_ptr; }
  bool ring_full() const { return ((ring_write - ring_tail()) & ring_mask) == ring.size(); }
  bool ring_has_stamp_work() const { return ring_stamp != ring_write; }
  bool enable(bool fragment_ready) const { return !stage(last_stage).drawn || fragment_ready; }
  const TileEntry& ring_at(std::uint32_t pointer) const { return ring[pointer & (ring.size() - 1)]; }

  /// The walk has an entry for the ring.
  bool walk_wants_push() const {
    return walk.state() == TileWalk::State::end || (walk.state() == TileWalk::State::tile && walk.hit());
  }

  /// What the stamp unit finds at its pointer: an entry to push (mask 0 and not end: nothing to push for this row).
  StampEntry stamp_work() const {
    const TileEntry& tile = ring_at(ring_stamp);
    StampEntry s;
    s.tile_ptr = ring_stamp;
    if (tile.end) {
      s.end = true;
      return s;
    }
    const StampMasks masks = stamp_coverage(tile, slots[tile.slot].constants, stamp_row, context.config, context.state);
    s.row = stamp_row;
    s.mask = masks.mask;
    s.front = masks.front;
    s.tie = masks.tie;
    return s;
  }

  // Evaluated once per clock by refresh() and used by both comb() and clock().
  bool walk_wants = false, walk_push = false, stamp_present = false, stamp_push = false;
  TileEntry tile_entry;
  StampEntry stamp_entry;

  void refresh() {
    walk_wants = walk_wants_push();
    walk_push = walk_wants && !ring_full();
    if (walk_push) tile_entry = walk.entry();
    stamp_present = ring_has_stamp_work();
    stamp_push = false;
    if (stamp_present) {
      stamp_entry = stamp_work();
      stamp_push = (stamp_entry.end || stamp_entry.mask != 0) && !fifo.full();
    }
  }

  void reset() {
    assembly.count = 0;
    assembly.full = false;
    setup.busy = false;
    alloc = in_use = 0;
    walk = TileWalk(context.config, context.state);
    ring_write = ring_stamp = 0;
    stamp_row = 0;
    fifo.clear();
    first = true;
    for (PixelTrace& p : pipeline) p = {};
    refresh();
  }

  void clock_pixels() {
    PixelTrace& entering = pipeline[(head + pipeline.size() - 1) % pipeline.size()];
    entering.valid = entering.end = entering.drawn = false;
    if (!fifo.empty()) {
      const StampEntry& s = fifo.head();
      const TileEntry& tile = ring_at(s.tile_ptr);
      bool pop = true;
      if (s.end) {
        entering.end = true;
        entering.slot = tile.slot;
      } else {
        const std::uint32_t mask = first ? s.mask : rest;
        const int dx = std::countr_zero(mask);
        entering.front = s.front >> dx & 1;
        entering.tie = s.tie >> dx & 1;
        const Slot& slot = slots[tile.slot];
        pixel_pipeline(entering, tile, slot.constants, slot.data, dx, s.row, context);
        rest = mask & (mask - 1);
        pop = rest == 0;
        first = pop;
      }
      if (pop) fifo.pop();
    }
    head = (head + pipeline.size() - 1) % pipeline.size();
  }

  void clock(const ClockedInputs& in) {
    if (in.reset) {
      reset();
      return;
    }
    // All conditions first: every unit sees the state before the edge.
    const bool en = enable(in.fragment_ready);
    const bool starting = start();
    const bool taking = take();
    const bool accept = in.vertex_valid && !assembly.full;
    const bool release = en && stage(last_stage).end;
    const bool push_tile = walk_push;
    const bool walk_moves = walk.state() != TileWalk::State::idle && (push_tile || !walk_wants);
    const bool stamp_moves = stamp_present && (stamp_push || !(stamp_entry.end || stamp_entry.mask != 0));
    const bool push_stamp = stamp_push;

    if (en) clock_pixels();
    if (push_stamp) fifo.push(stamp_entry);
    if (stamp_moves) {
      const bool leave = stamp_entry.end || stamp_row == context.config.tile() - 1;
      if (leave) ring_stamp = (ring_stamp + 1) & ring_mask;
      stamp_row = leave ? 0 : stamp_row + 1;
    }
    if (push_tile) {
      ring[ring_write & (ring.size() - 1)] = tile_entry;
      ring_write = (ring_write + 1) & ring_mask;
    }
    if (walk_moves) walk.advance();
    if (taking) {
      slots[setup.result.slot].constants = QuadConstants(setup.result);
      walk.take(setup.result);
      setup.busy = false;
    } else if (setup.busy && setup.remaining > 0) {
      --setup.remaining;
    }
    if (starting) {
      setup.result = quad_setup(assembly.quad, context.config, context.state);
      setup.result.slot = alloc;
      slots[alloc].data = quad_data(assembly.quad, setup.result, context.config, context.state);
      setup.busy = true;
      setup.remaining = quad_setup_clocks(setup.result.homogeneous);
      alloc = (alloc + 1) % static_cast<std::uint32_t>(slots.size());
      assembly.full = false;
    }
    in_use += (starting ? 1u : 0u) - (release ? 1u : 0u);
    if (accept) {
      if (assembly.count == 0) assembly.quad.id = in.vertex_id;
      assembly.quad.vertex[static_cast<std::size_t>(assembly.count)] = in.vertex;
      assembly.full = assembly.count == 3;
      assembly.count = (assembly.count + 1) % 4;
    }
    refresh();
  }
};

ClockedModel::ClockedModel(const Config& config, const DrawState& state) {
  config.validate();
  impl_ = std::make_unique<Impl>(config, state);
}
ClockedModel::~ClockedModel() = default;
ClockedModel::ClockedModel(ClockedModel&&) noexcept = default;
ClockedModel& ClockedModel::operator=(ClockedModel&&) noexcept = default;

ClockedOutputs ClockedModel::comb() const {
  const Impl& m = *impl_;
  ClockedOutputs out;
  out.vertex_ready = !m.assembly.full;
  const PixelTrace& last = m.stage(last_stage);
  out.fragment_valid = last.drawn;
  if (last.drawn) out.fragment = last.fragment;
  out.busy = m.assembly.full || m.assembly.count != 0 || m.in_use != 0;
  if (m.take()) out.probes.setup = &m.setup.result;
  if (m.walk_push) out.probes.tile = &m.tile_entry;
  if (m.stamp_push) out.probes.stamp = &m.stamp_entry;
  const auto pixel = [&](int n) { return m.stage(n).valid ? &m.stage(n) : nullptr; };
  out.probes.diff = pixel(latency::diff_stage);
  out.probes.norm = pixel(latency::norm_stage);
  out.probes.rsqrt = pixel(latency::rho_stage);
  out.probes.ratio = pixel(latency::ratio_stage);
  out.probes.weight = pixel(latency::weight_stage);
  out.probes.sum = pixel(latency::sum_stage);
  return out;
}

void ClockedModel::clock(const ClockedInputs& inputs) { impl_->clock(inputs); }

}  // namespace quadrille
