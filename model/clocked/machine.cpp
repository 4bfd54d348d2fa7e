// The machine: its units, wired as rtl/quadrille.sv wires them.
#include "model/clocked.hpp"
#include "model/clocked/fragment_fifo.hpp"
#include "model/clocked/hierarchical_z.hpp"
#include "model/clocked/pixel_emit.hpp"
#include "model/clocked/pixel_pipeline.hpp"
#include "model/clocked/quad_setup.hpp"
#include "model/clocked/quad_slots.hpp"
#include "model/clocked/stamp_coverage.hpp"
#include "model/clocked/sync_fifo.hpp"
#include "model/clocked/tile_context.hpp"
#include "model/clocked/tile_ring.hpp"
#include "model/clocked/tile_walk.hpp"
#include "model/clocked/vertex_assembly.hpp"
#include "model/port/draw_state.hpp"

#include <stdexcept>

namespace quadrille {

struct ClockedModel::Impl {
  PipelineContext context;
  clocked::VertexAssembly assembly;
  clocked::QuadSetup setup;
  clocked::QuadSlots slots;
  clocked::TileWalk walk;
  clocked::HierarchicalZ hidden;
  clocked::TileContext tile_context;
  clocked::TileRing ring;
  clocked::StampCoverage coverage;
  clocked::SyncFifo<StampEntry> stamps;
  clocked::PixelEmit emit;
  clocked::PixelPipeline pipeline;
  clocked::FragmentFifo fragments;
  PerformanceCounters counters;  ///< but for those of the pipeline
  int vertex_products;           ///< of a job of the dot units

  Impl(const Config& config, const DrawState& state, Probes probes)
      : context(config, state),
        slots(config),
        ring(config),
        stamps(static_cast<std::size_t>(stamp_places(config))),
        emit(context),
        pipeline(context, probes),
        vertex_products(UnitProducts(config).vertex_products) {
    reset();
  }

  void reset() {
    assembly.reset();
    setup = {};
    setup.pairs = context.config.product_pairs();
    slots.reset();
    walk = {};
    walk.walk = TileWalk(context.config, context.state);
    hidden.reset(context.config);
    tile_context = {};
    tile_context.pairs = context.config.product_pairs();
    ring.reset();
    coverage = {};
    coverage.room = stamp_places(context.config);
    stamps.clear();
    emit.reset();
    pipeline.reset();
    fragments.reset();
    counters = {};
  }

  // Conditions of this clock, from registered state.
  bool take() const { return setup.ready_for_walk() && walk.ready(); }
  bool start() const { return assembly.waits && setup.ready(take(), tile_context.issues()) && slots.available(); }
  bool vertex_ready() const { return hidden.wiping == 0 && assembly.ready(); }
  bool quads_under_way() const { return assembly.busy() || slots.in_use != 0 || !fragments.beats.empty(); }
  bool busy() const { return quads_under_way() || hidden.wiping > 0; }

  /// performance_counters: what bounds this clock.
  PerformanceCounter bound(bool starting, bool taking) const {
    BoundInputs bound;
    bound.head = stamps.valid();
    bound.head_waits = bound.head && !stamps.head().end && emit.places <= 0;
    bound.rows = coverage.rows_valid;
    bound.rows_behind = coverage.context_valid;
    bound.walk = walk.walk.state() != TileWalk::State::idle;
    bound.walk_behind = setup.ready_for_walk() && !taking;
    bound.setup = setup.busy();
    bound.setup_behind = assembly.waits && !starting;
    bound.assembly = assembly.busy();
    bound.wipe = hidden.wiping > 0;
    bound.busy = busy();
    return bound_of(bound);
  }

  void clock(const ClockedInputs& in) {
    if (in.reset) return reset();
    // All conditions first: every unit sees the state before the edge.
    const bool starting = start(), taking = take();
    const bool accept = in.vertex_valid && vertex_ready();
    const bool clearing = in.clear_hidden && !busy();
    const bool units_taken = tile_context.issues();
    const clocked::TileWalk::Step& step = walk.way.back();
    const bool homogeneous = step.push && !step.entry.end && slots[step.entry.slot].constants.homogeneous;
    const bool push_tile = step.push && tile_context.ready() && ring.room(homogeneous);
    const TileEntry* const tile = push_tile ? &step.entry : nullptr;
    const bool walk_moves = push_tile || !step.push;
    const int places_back = (fragments.freed ? 1 : 0) + (pipeline.discards() ? 1 : 0);
    const clocked::Pixel& last = pipeline.stage(clocked::PixelPipeline::last_stage).front();
    std::uint32_t leaving = last.end ? 1u << last.slot : 0;
    if (setup.drops()) leaving |= 1u << setup.dropped().slot;

    ++counters[PerformanceCounter::clocks];
    assembly.count_quads(counters, starting, context);
    setup.count(counters, taking, context.state);
    walk.count(counters, walk_moves, push_tile);
    if (units_taken || setup.has_jobs())
      counters[PerformanceCounter::products_vertex_products] += static_cast<std::uint64_t>(vertex_products);
    ++counters[bound(starting, taking)];

    fragments.clock(in.fragment_ready, pipeline.stage(clocked::PixelPipeline::last_stage));
    pipeline.clock();
    const bool pop = emit.clock(places_back, stamps, ring, slots, pipeline, context);
    const clocked::StampCoverage::Row& row = coverage.way.back();
    if (stamps.valid())
      ring.tail = stamps.head().tile_ptr;
    else if (stamps.empty())
      ring.tail = row.pointer;
    if (row.push()) stamps.next() = row.stamp;
    stamps.clock(pop, row.push());
    coverage.clock(pop, ring, slots, hidden, context, counters);
    ring.clock(tile_context.way.back(), tile, homogeneous);
    tile_context.clock(tile, homogeneous);
    if (walk_moves) walk.clock();
    hidden.clock(clearing, context.config.hierarchical_z_bits != 0);
    if (taking) {
      const SetupResult& quad = setup.result.setup;
      slots[quad.slot].constants = QuadConstants(quad);
      walk.take(quad, skips_hidden(context.config, context.state) ? &hidden.memory : nullptr, slots[quad.slot].depth);
    }
    const std::uint32_t slot = slots.alloc;
    slots.clock(starting, leaving);
    setup.clock(assembly.waits, taking, units_taken);
    if (starting) begin_quad(slot);
    assembly.clock(in, starting, accept, context);
    if (pipeline.traced()) pipeline.show_probes();
  }

  void begin_quad(std::uint32_t slot) {
    const SnappedQuad& quad = assembly.waiting.quad;
    SetupResult result = quad_setup(quad, context.config, context.state);
    result.slot = slot;
    clocked::QuadSlots::Slot& held = slots[slot];
    held.quad = assembly.waiting.number;
    held.depth = depth_interval(quad, context.config, context.state);
    held.data = quad_data(quad, result, context.config, context.state);
    if (!pipeline.traced()) emit.ahead.take(result, held);
    setup.start(result, context.state);
  }

  ClockedOutputs outputs() const {
    ClockedOutputs out;
    out.vertex_ready = vertex_ready();
    out.fragment_valid = fragments.beats.valid();
    for (std::size_t lane = 0; out.fragment_valid && lane < pipeline.lanes(); ++lane)
      if (const auto& beat = fragments.beats.head(); (beat.drawn >> lane & 1) != 0)
        out.fragment[lane] = &pipeline.fragment(beat.fragment[lane]);
    out.busy = busy();
    if (take()) {
      out.probes.setup = &setup.result.setup;
      out.probes.setup_quad = slots[setup.result.setup.slot].quad;
    }
    if (ring.completed) out.probes.tile = &ring.at(ring.last_completed);
    if (coverage.way.back().push()) out.probes.stamp = &coverage.way.back().stamp;
    for (const clocked::Pixel& p : pipeline.stage(latency::diff_stage)) out.probes.pixels += p.valid ? 1 : 0;
    out.probes.lane = pipeline.probes();
    return out;
  }

  void set_state(const DrawState& state) {
    if (quads_under_way()) throw std::logic_error("the draw state cannot change while quads are under way");
    check_draw_state(state, context.config);
    pipeline.count_before_change(counters);
    context = PipelineContext(Config(context.config), state);
    emit.ahead.set_state();
    pipeline.set_state();
    walk.walk = TileWalk(context.config, state);
  }
};

ClockedModel::ClockedModel(const Config& config, const DrawState& state, Probes probes) {
  config.validate();
  check_draw_state(state, config);
  impl_ = std::make_unique<Impl>(config, state, probes);
}
ClockedModel::~ClockedModel() = default;
ClockedModel::ClockedModel(ClockedModel&&) noexcept = default;
ClockedModel& ClockedModel::operator=(ClockedModel&&) noexcept = default;

ClockedOutputs ClockedModel::comb() const { return impl_->outputs(); }
bool ClockedModel::quads_under_way() const { return impl_->quads_under_way(); }
void ClockedModel::set_state(const DrawState& state) { impl_->set_state(state); }
void ClockedModel::clock(const ClockedInputs& inputs) { impl_->clock(inputs); }
PerformanceCounters ClockedModel::counters() const {
  PerformanceCounters counters = impl_->counters;
  impl_->pipeline.count(counters);
  return counters;
}

}  // namespace quadrille
