#include "model/clocked.hpp"

#include "model/draw_state.hpp"
#include "model/latency.hpp"
#include "model/masked_depth.hpp"
#include "model/pixel_pipeline.hpp"
#include "model/pixels_ahead.hpp"
#include "model/plane_quad.hpp"
#include "model/quad_reject.hpp"
#include "model/quad_setup.hpp"
#include "model/stamp_coverage.hpp"
#include "model/tile_context.hpp"

#include <algorithm>
#include <bit>
#include <span>
#include <stdexcept>
#include <vector>

namespace quadrille {
namespace {

constexpr int last_stage = latency::fragment_stage;
constexpr int emit_stages = latency::emission;
/// Registers of the delay line of pixels, at least one for each stage.
constexpr std::size_t pipeline_registers = std::bit_ceil(static_cast<std::size_t>(emit_stages + last_stage + 1));
/// quadrille_pkg::FRAGMENT_FIFO_LOG2: at full rate a place is free again so many clocks after its pixel was sent.
constexpr std::size_t fragment_places = std::bit_ceil(
    static_cast<std::size_t>(latency::emission + latency::pipeline + latency::fragment_fifo + latency::place_back));

/// First-in first-out memory with its head in a register, as the RTL's: a word becomes the head two edges after its
/// push. Who pushes knows that there is room. (Here the head stays where it is in the memory, which has a place more.)
template <class T>
class Fifo {
 public:
  explicit Fifo(std::size_t capacity) : slots_(capacity + 1) {}
  bool valid() const { return valid_; }
  bool empty() const { return count_ == 0 && !valid_; }
  const T& head() const { return slots_[first_]; }
  /// The head and the words behind it, those too that are not the head yet.
  std::size_t words() const { return count_ + (valid_ ? 1 : 0); }
  const T& word(std::size_t n) const { return slots_[wrapped(first_ + n)]; }
  /// Where the next word is written before it is pushed.
  T& next() { return slots_[wrapped(first_ + count_ + (valid_ ? 1 : 0))]; }
  /// The edge: the head leaves, the word in next() comes in.
  void clock(bool pop, bool push) {
    const bool load = count_ != 0 && (!valid_ || pop);
    if (valid_ && pop) first_ = wrapped(first_ + 1);
    valid_ = load || (valid_ && !pop);
    if (load) --count_;
    if (push) ++count_;
  }
  void clear() {
    first_ = count_ = 0;
    valid_ = false;
  }

 private:
  std::size_t wrapped(std::size_t place) const { return place < slots_.size() ? place : place - slots_.size(); }

  std::vector<T> slots_;
  std::size_t first_ = 0, count_ = 0;  ///< the head or the word that will be; the words behind the head
  bool valid_ = false;
};

/// The clocks of tile_walk: what is tested goes through two registers to the ring, and a block's test is known a clock
/// after the walk went on.
struct WalkUnit {
  struct Step {
    bool push = false;
    TileEntry entry;
  };

  /// Tests whose result is known in this clock.
  struct Tests {
    bool block = false, enter = false, block_hidden = false, tile = false, hidden = false;
  };

  TileWalk walk;
  Tests tests;
  bool wait = false;          ///< the walk stands: the block tested in the clock before is entered, or was the last
  bool finishing = false;     ///< the end entry is on its way
  std::array<Step, 2> way{};  ///< steps on their way to the ring, the last one pushes

  /// The end entry waits to be pushed, and all tiles are in the ring.
  bool at_end() const { return finishing && way.back().push && way.back().entry.end; }
  bool ready() const { return walk.state() == TileWalk::State::idle || at_end(); }
  /// The next quad comes in, once ready(); after clock(), if the walk moves.
  void take(const SetupResult& setup, HierarchicalZ* memory, const DepthInterval& depth) {
    walk.take(setup, memory, depth);
    finishing = false;
  }

  /// The edge, unless a push waits for the ring.
  void clock() {
    if (at_end()) {
      walk.advance();
      finishing = false;
    }
    for (std::size_t n = way.size() - 1; n > 0; --n) {
      way[n].push = way[n - 1].push;
      if (way[n].push) way[n].entry = way[n - 1].entry;  // most steps push nothing, and an entry is large
    }
    Step& step = way.front();
    step.push = false;
    tests = {};
    if (wait) {
      wait = false;
      return;
    }
    switch (walk.state()) {
      case TileWalk::State::idle:
        break;
      case TileWalk::State::approach:
        walk.advance();
        break;
      case TileWalk::State::block:
        wait = walk.hit();
        tests.block = true;
        tests.enter = wait;
        tests.block_hidden = walk.hidden();
        walk.advance();
        wait = wait || walk.state() == TileWalk::State::end;
        break;
      case TileWalk::State::tile:
        step.push = walk.hit();
        tests.tile = true;
        tests.hidden = walk.hidden();
        if (step.push) step.entry = walk.entry();
        walk.advance();
        break;
      case TileWalk::State::end:
        step.push = !finishing;
        if (step.push) step.entry = walk.entry();
        finishing = true;
        break;
    }
  }
};

/// The control half of tile_context: a tile's steps, one a clock, and the words on their way to the ring.
struct ContextUnit {
  int pairs = 1;  ///< of dot units
  bool active = false, homogeneous = false, end = false;
  int step = 0;
  std::array<bool, tile_context_result_clocks> way{};  ///< last steps; the last one makes its entry visible

  int last_step() const { return end ? 1 : tile_context_last_step(homogeneous, pairs); }
  bool ready() const { return !active || step == last_step(); }
  /// The step is a job for the dot units, which then do none of the setup.
  bool issues() const {
    if (!active || step == 0 || end) return false;
    if (!homogeneous) return true;
    return step <= tile_context_last_move(pairs) || step >= tile_context_first_product;
  }

  /// The edge; an entry (or nullptr) comes in, of a homogeneous quad's tile or not.
  void clock(const TileEntry* push, bool push_homogeneous) {
    for (std::size_t n = way.size() - 1; n > 0; --n) way[n] = way[n - 1];
    way[0] = active && step == last_step();
    if (active && step++ == last_step()) active = false;
    if (push != nullptr) {
      active = true;
      homogeneous = push_homogeneous;
      end = push->end;
      step = 0;
    }
  }
};

/// Entries of the ring that a tile takes: one, or one for each part of its functions.
std::uint32_t entries_of(bool homogeneous) { return homogeneous ? latency::homogeneous_parts : 1; }

/// stamp_coverage: an entry comes through three registers, then its rows through three.
struct CoverageUnit {
  struct Row {
    bool valid = false;
    std::uint32_t pointer = 0;  ///< no row before this entry is still to come
    StampEntry stamp;

    bool push() const { return valid && (stamp.end || stamp.mask != 0); }
  };

  std::uint32_t fetch = 0, load = 0, rows = 0;  ///< next entry of each register; the rows' own while rows_valid
  bool tag_valid = false, context_valid = false, rows_valid = false;
  int row = 0;
  bool hidden = false;                 ///< nothing of the tile whose row was issued last can be seen
  static constexpr int wait_bits = 3;  ///< of a tile's x and y: those that are looked at to wait for one before it
  std::array<Row, 3> way{};            ///< rows on their way to the FIFO, the last one pushes
  int room = 0;                        ///< places of the FIFO that neither a stamp has nor a row on its way
  bool freed = false;                  ///< a stamp left the FIFO in the clock before
};

/// vertex_assembly: four beats make a quad.
struct VertexAssembly {
  SnappedQuad quad;
  std::size_t number = 0;  ///< of the quad: those before it
  int count = 0;
  bool full = false;
  QuadReject reject = QuadReject::none;  ///< by the vertices, once full

  /// The quad is left out in this clock.
  bool drops() const { return full && reject != QuadReject::none; }
};

/// The control half of quad_setup; the bits come from the function of that name at start. Four quads may be there: one
/// does its steps (front), one whose results are still to come waits (middle), of one they come (sum), one waits
/// complete for the walk (done).
struct SetupUnit {
  struct Quad {
    SetupResult setup;
    bool left_out = false;  ///< by its areas
  };

  int pairs = 1;        ///< of dot units
  int box = 0;          ///< clocks of the bounding box, of the quad in vertex_assembly: 2 when it is there
  int all_steps = 0;    ///< of the quad that does them
  int steps = 0;        ///< left to do
  bool front = false;   ///< `next` has started; then it goes to the middle, which is free
  bool middle = false;  ///< `waiting` has not moved on
  bool sum = false;     ///< `summed` has not
  std::array<bool, quad_setup_result_clocks(2)> ends{};  ///< last steps whose results are on their way
  bool complete = false;                                 ///< all of `summed` is there
  bool done = false;                                     ///< `result` is there, neither taken nor dropped yet
  Quad next, waiting, summed, result;

  bool busy() const { return front || middle || sum || done; }
  /// The step of this clock has jobs for the dot units, should they be free.
  bool has_jobs() const {
    const int step = all_steps - steps;
    return steps > 0 && !(pairs == 2 && next.setup.homogeneous && (step == 6 || (step >= 15 && step <= 17)));
  }
  /// The last step is done in this clock; the steps wait while the dot units work for a tile.
  bool ends_run(bool units_taken) const { return steps == 1 && !units_taken; }

  bool drops_result() const { return done && result.left_out; }
  /// An ordinary quad's areas are known a clock before all of it; then it goes no further.
  bool drops_summed() const {
    const bool areas_known = complete || ends[static_cast<std::size_t>(quad_setup_result_clocks(pairs) - 1)];
    return sum && areas_known && !summed.setup.homogeneous && summed.left_out && !drops_result();
  }
  bool drops() const { return drops_result() || drops_summed(); }
  /// The quad that is left out in this clock, where drops().
  const SetupResult& dropped() const { return drops_result() ? result.setup : summed.setup; }
  /// `result` waits for the walk.
  bool ready_for_walk() const { return done && !result.left_out; }

  /// A quad may start: those before it will have moved on when its first result comes. `taken`: the walk takes
  /// `result`.
  bool ready(bool taken, bool units_taken) const {
    const bool run_over = steps == 0 || (pairs == 1 && ends_run(units_taken));
    const bool gone = taken || drops_result();
    const bool alone = !(sum && middle) || drops_summed();
    return box == 2 && run_over && alone && (!(sum || middle) || !done || gone);
  }

  /// The edge; start() comes after it. `held`: vertex_assembly has a quad.
  void clock(bool held, bool taken, bool units_taken) {
    const bool left_out = drops_summed();
    const bool gone = taken || drops_result();
    const bool hand_over = complete && !left_out && (!done || gone);
    const bool advance = middle && (!sum || hand_over || left_out);
    if (gone) done = false;
    if (hand_over) {
      result = summed;
      done = true;
    }
    if (hand_over || left_out) sum = false;
    if (advance) {
      summed = waiting;
      middle = false;
      sum = true;
    }
    if (front) {
      waiting = next;
      front = false;
      middle = true;
    }
    complete =
        (ends[static_cast<std::size_t>(quad_setup_result_clocks(pairs) - 1)] || (complete && !hand_over)) && !left_out;
    for (std::size_t n = ends.size() - 1; n > 0; --n) ends[n] = ends[n - 1];
    ends[0] = ends_run(units_taken);
    if (steps > 0 && !units_taken) --steps;
    if (box != 0 || held) box = std::min(box + 1, 2);
  }

  void start(const SetupResult& quad, const DrawState& state) {
    next = {quad, reject_by_areas(quad, state) != QuadReject::none};
    front = true;
    steps = all_steps = quad_setup_steps(quad.homogeneous, pairs, state);
    box = 0;
  }
};

/// The control of hierarchical_z: clocks in which words are wiped and no vertex is taken.
struct HiddenUnit {
  static constexpr int section = 16;  ///< places that a clear wipes

  HierarchicalZ memory;
  MaskedDepth masked;
  int wiping = 0;

  void reset(const Config& config) {
    memory = HierarchicalZ(config);
    masked = MaskedDepth(config);
    wiping = config.hierarchical_z_bits != 0 ? 1 << config.hierarchical_z_tiles_log2 : 0;
  }
  void clock(bool clear, bool present) {
    if (wiping > 0) {
      --wiping;
    } else if (clear && present) {
      memory.clear();
      masked.clear();
      wiping = section;
    }
  }
};

/// What leaves the pipeline in a clock: the fragments of its lanes, those that are drawn, by their places.
struct FragmentBeat {
  std::uint32_t drawn = 0;
  std::array<std::uint32_t, Config::most_pixels_per_clock> fragment;
};

/// A pixel on its way.
struct Pixel {
  bool valid = false, end = false;
  std::uint8_t kind = 0;       ///< PixelKind bits
  std::uint32_t slot = 0;      ///< of an end
  std::uint32_t fragment = 0;  ///< its place

  bool drawn() const { return valid && (kind & pixel_drawn) != 0; }
};

/// What a slot of the bank holds: the back half's data and the front half's constants.
struct Slot : PixelQuad {
  DepthInterval depth;
  std::size_t quad = 0;  ///< VertexAssembly::number
};

}  // namespace

struct ClockedModel::Impl {
  PipelineContext context;
  VertexAssembly assembly;
  SetupUnit setup;
  std::vector<Slot> slots;
  std::uint32_t alloc = 0;   ///< the slot that the next quad gets, once it is free
  std::uint32_t in_use = 0;  ///< bit i: slot i
  WalkUnit walk;
  HiddenUnit hidden;
  ContextUnit tile_unit;
  std::vector<TileEntry> ring;
  /// The next entry to write, the first one that coverage must not see yet, the first one in use.
  std::uint32_t ring_write = 0, ring_complete = 0, ring_tail = 0, ring_mask;
  bool completed = false;  ///< an entry became visible at the last edge: the one at last_completed
  std::uint32_t last_completed = 0;
  CoverageUnit coverage;
  Fifo<StampEntry> stamps;
  std::uint32_t rest = 0;  ///< bits of the head's mask still to be emitted; valid when !first
  bool first = true;
  int part = 0;                  ///< parts of the pixels that were sent, of a homogeneous quad
  int places = fragment_places;  ///< of the fragment FIFO that neither fragments have nor pixels on their way
  bool handed_over = false;      ///< fragments left in the clock before
  PixelsAhead ahead;
  /// A delay line from emission to the last register, `lanes` pixels for each: those of stage n begin at place(n).
  std::size_t lanes;
  std::vector<Pixel> pipeline;
  std::size_t head = 0;
  /// Fragments of pixels on their way and in the FIFO, which has a place for each (pixel_emit counts them).
  std::vector<Fragment> on_way;
  std::uint32_t next_place = 0;
  /// Beside the pixels, with probes of them.
  std::vector<PixelTrace> traces;
  std::array<LaneProbes, Config::most_pixels_per_clock> lane_probes{};
  /// Pixels that were sent, by lane and kind: what the stages' counters are made of when they are read.
  std::array<std::array<std::uint64_t, pixel_kinds>, Config::most_pixels_per_clock> sent{};
  std::array<WantedSums, 2> wanted;  ///< of pixels of a quad without and with the eye in its hull
  Fifo<FragmentBeat> fragments;
  PerformanceCounters counters;  ///< but for the pixels in `sent`
  UnitProducts products;

  Impl(const Config& config, const DrawState& state, Probes probes)
      : context(config, state),
        slots(static_cast<std::size_t>(config.quad_slots())),
        ring(static_cast<std::size_t>(ring_entries(config))),
        ring_mask(static_cast<std::uint32_t>(2 * ring_entries(config) - 1)),
        stamps(static_cast<std::size_t>(stamp_places(config))),
        ahead(context),
        lanes(static_cast<std::size_t>(config.pixels_per_clock)),
        pipeline(pipeline_registers * lanes),
        on_way(fragment_places * lanes),
        traces(probes == Probes::all ? pipeline.size() : 0),
        wanted{WantedSums(config, state, false), WantedSums(config, state, true)},
        fragments(fragment_places),
        products(config) {
    reset();
  }

  std::size_t place(int n) const {
    return (head + static_cast<std::size_t>(emit_stages + n)) % pipeline_registers * lanes;
  }
  std::span<const Pixel> stage(int n) const { return {&pipeline[place(n)], lanes}; }

  // Conditions of this clock, from registered state.
  bool start() const {
    return assembly.full && !assembly.drops() && setup.ready(take(), tile_unit.issues()) && (in_use >> alloc & 1) == 0;
  }
  bool take() const { return setup.ready_for_walk() && walk.ready(); }
  /// Of the quad that setup has complete, if it has one.
  const Slot& complete_slot() const { return slots[setup.result.setup.slot]; }
  bool ring_full(std::uint32_t entries) const { return ((ring_write - ring_tail) & ring_mask) + entries > ring.size(); }
  const TileEntry& ring_at(std::uint32_t pointer) const { return ring[pointer & (ring.size() - 1)]; }

  bool walk_push() const {
    const WalkUnit::Step& step = walk.way.back();
    return step.push && tile_unit.ready() && !ring_full(entries_of(is_homogeneous(step.entry)));
  }

  /// The row that stamp_coverage is at.
  StampEntry stamp_work() {
    const TileEntry& tile = ring_at(coverage.rows);
    StampEntry s;
    s.tile_ptr = coverage.rows;
    coverage.hidden = false;
    if (tile.end) {
      s.end = true;
      return s;
    }
    s.row = coverage.row;
    // The RTL writes what is held of the tile some clocks later; no tile reads it before that (tile_waits).
    const bool hides = skips_hidden(context.config, context.state);
    if (hides && coverage.row == 0) hidden.masked.begin(tile.tile_x, tile.tile_y, slots[tile.slot].depth);
    coverage.hidden = hides && hidden.masked.hidden();
    if (coverage.hidden) return s;
    const StampMasks masks =
        stamp_coverage(tile, slots[tile.slot].constants, coverage.row, context.config, context.state);
    s.mask = hides ? hidden.masked.row(coverage.row, masks.mask) : masks.mask;
    s.front = masks.front & s.mask;
    s.tie = masks.tie & s.mask;
    if (hides && coverage.row == tile.last_row) hidden.masked.end();
    return s;
  }

  /// The tile in coverage's tag register stays there: one before it that may lower what is held of the same place, or
  /// of one that has the same low bits, has not written yet.
  bool tile_waits() const {
    const CoverageUnit& c = coverage;
    if (!skips_hidden(context.config, context.state)) return false;
    const TileEntry& tile = ring_at(c.load);
    if (tile.end) return false;
    constexpr int low = (1 << CoverageUnit::wait_bits) - 1;
    const auto holds_up = [&](std::uint32_t pointer) {
      const TileEntry& before = ring_at(pointer);
      return !before.end && slots[before.slot].depth.lowers && ((before.tile_x ^ tile.tile_x) & low) == 0 &&
             ((before.tile_y ^ tile.tile_y) & low) == 0;
    };
    if (c.context_valid && holds_up(c.rows_valid ? behind(c.rows) : c.rows)) return true;
    if (c.rows_valid && holds_up(c.rows)) return true;
    return std::ranges::any_of(c.way, [&](const CoverageUnit::Row& row) { return row.valid && holds_up(row.pointer); });
  }

  void reset() {
    assembly.number = 0;
    assembly.count = 0;
    assembly.full = false;
    setup = {};
    setup.pairs = context.config.product_pairs();
    alloc = in_use = 0;
    walk = {};
    walk.walk = TileWalk(context.config, context.state);
    hidden.reset(context.config);
    tile_unit = {};
    tile_unit.pairs = context.config.product_pairs();
    ring_write = ring_complete = ring_tail = 0;
    completed = false;
    coverage = {};
    coverage.room = stamp_places(context.config);
    stamps.clear();
    first = true;
    part = 0;
    places = fragment_places;
    handed_over = false;
    ahead.clear();
    for (Pixel& p : pipeline) p = {};
    fragments.clear();
    counters = {};
    sent = {};
  }

  bool quads_under_way() const { return assembly.full || assembly.count != 0 || in_use != 0 || !fragments.empty(); }
  bool busy() const { return quads_under_way() || hidden.wiping > 0; }

  /// performance_counters: what this clock does, from the state before its edge.
  void count(bool starting, bool taking, bool dropping, bool push_tile, bool walk_moves) {
    using enum PerformanceCounter;
    const auto add = [this](PerformanceCounter counter, auto amount) {
      counters[counter] += static_cast<std::uint64_t>(amount);
    };
    add(clocks, 1);
    add(quads, starting || assembly.drops());
    if (assembly.drops())
      add(assembly.reject == QuadReject::empty    ? quads_empty
          : assembly.reject == QuadReject::behind ? quads_behind
                                                  : quads_depth,
          1);
    if (dropping)
      add(reject_by_areas(setup.dropped(), context.state) == QuadReject::line ? quads_line : quads_culled, 1);
    if (taking) add(setup.result.setup.homogeneous ? quads_homogeneous : quads_ordinary, 1);
    add(quads_plane, starting && plane_quad(assembly.quad, context.config, context.state));

    add(blocks_tested, walk_moves && walk.tests.block);
    add(blocks_entered, walk_moves && walk.tests.enter);
    add(blocks_hidden, walk_moves && walk.tests.block_hidden);
    add(tiles_tested, walk_moves && walk.tests.tile);
    add(tiles_entered, push_tile && !walk.way.back().entry.end);
    add(tiles_hidden, walk_moves && walk.tests.hidden);
    add(stamps, coverage.way.back().push() && !coverage.way.back().stamp.end);

    if (tile_unit.issues() || setup.has_jobs()) add(products_vertex_products, products.vertex_products);
    BoundInputs bound;
    bound.head = this->stamps.valid();
    bound.head_waits = bound.head && !this->stamps.head().end && places <= 0;
    bound.rows = coverage.rows_valid;
    bound.rows_behind = coverage.context_valid;
    bound.walk = walk.walk.state() != TileWalk::State::idle;
    bound.walk_behind = setup.ready_for_walk() && !taking;
    bound.setup = setup.busy();
    bound.setup_behind = assembly.full && !starting && !assembly.drops();
    bound.assembly = assembly.full || assembly.count != 0;
    bound.wipe = hidden.wiping > 0;
    bound.busy = busy();
    add(bound_of(bound), 1);
  }

  /// Adds the pixels in `sent` as far as each stage has seen them: all but those before it or in it.
  void count_pixels(PerformanceCounters& to) const {
    using enum PerformanceCounter;
    std::array<std::int64_t, pixel_kinds> seen{};  // by the stage in question
    for (const auto& lane : sent)
      for (std::size_t kind = 0; kind < pixel_kinds; ++kind) seen[kind] += static_cast<std::int64_t>(lane[kind]);
    const auto total = [&](auto&& of_kind) {
      std::int64_t sum = 0;
      for (std::size_t kind = 0; kind < pixel_kinds; ++kind) sum += seen[kind] * of_kind(kind);
      return static_cast<std::uint64_t>(sum);
    };
    const auto sums = [&](int WantedSums::*what) {
      return total([&](std::size_t kind) { return wanted[(kind & pixel_hull) != 0 ? 1 : 0].*what; });
    };
    // Operands that are held make no product.
    const bool held = (context.state.skip & skip_operands) != 0;
    const auto off_corners = [&] {
      return total(
          [&](std::size_t kind) { return (kind & pixel_plane) == 0 && !(held && (kind & pixel_corner) != 0) ? 1 : 0; });
    };
    const auto product = [](int count) { return static_cast<std::uint64_t>(count); };
    for (int n = -emit_stages; n <= last_stage; ++n) {
      const std::span<const Pixel> pixels = stage(n);
      for (std::size_t lane = 0; lane < lanes; ++lane) seen[pixels[lane].kind] -= pixels[lane].valid ? 1 : 0;
      if (n == latency::norm_stage) {
        to[pixels_plane] += total([](std::size_t kind) { return (kind & pixel_plane) != 0 ? 1 : 0; });
        to[products_sqrt] += off_corners() * product(products.sqrt);
      }
      if (n == latency::root_stage)
        to[products_mean_value_ratios] += off_corners() * product(products.mean_value_ratios);
      if (n == latency::ratio_stage)
        to[products_mean_value_weights] += off_corners() * product(products.weight_ratios) +
                                           total([](std::size_t kind) { return (kind & pixel_areas) == 0 ? 1 : 0; }) *
                                               product(products.weight_factors);
      if (n == latency::weight_stage) to[products_interpolate] += sums(&WantedSums::terms);
      if (n == latency::sum_stage)
        to[products_reciprocal] += sums(&WantedSums::denominators) * product(products.reciprocal);
      if (n == latency::fragment_stage - latency::fragment_output_stages)
        to[products_fragment_output] += sums(&WantedSums::quotients);
      if (n == last_stage)
        to[PerformanceCounter::fragments] += total([](std::size_t kind) { return (kind & pixel_drawn) != 0 ? 1 : 0; });
    }
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      std::uint64_t entered = 0;
      for (const std::uint64_t of_kind : sent[lane]) entered += of_kind;
      for (int n = -emit_stages; n <= 0; ++n) entered -= stage(n)[lane].valid ? 1 : 0;
      to[static_cast<PerformanceCounter>(static_cast<std::size_t>(pixels_lane0) + lane)] += entered;
    }
  }

  bool is_homogeneous(const TileEntry& tile) const { return !tile.end && slots[tile.slot].constants.homogeneous; }
  /// The pointer of the entry behind this one.
  std::uint32_t behind(std::uint32_t pointer) const {
    return (pointer + entries_of(is_homogeneous(ring_at(pointer)))) & ring_mask;
  }

  /// stamp_coverage and the stamp FIFO; `pop`: emission takes the head.
  void clock_stamps(bool pop) {
    CoverageUnit& c = coverage;
    const CoverageUnit::Row leaving = c.way.back();
    const bool waits = c.tag_valid && tile_waits();
    const bool issue = c.rows_valid && c.room != 0;
    for (std::size_t n = c.way.size() - 1; n > 0; --n) c.way[n] = c.way[n - 1];
    c.way[0].valid = issue;
    c.way[0].pointer = c.rows;
    if (issue) c.way[0].stamp = stamp_work();
    if (issue && !c.way[0].stamp.end)
      ++counters[c.hidden ? PerformanceCounter::tiles_masked : PerformanceCounter::rows_tested];

    const bool rows_done = issue && (c.way[0].stamp.end || c.hidden || c.row == ring_at(c.rows).last_row);
    const bool rows_load = c.context_valid && (!c.rows_valid || rows_done);
    const bool load = c.tag_valid && (!c.context_valid || rows_load) && !waits;
    const bool fetch = c.fetch != ring_complete && (!c.tag_valid || load);
    if (rows_done) c.rows = behind(c.rows);
    if (load) c.load = behind(c.load);
    if (fetch) c.fetch = behind(c.fetch);
    c.row = rows_load ? 0 : c.row + (issue ? 1 : 0);
    c.rows_valid = rows_load || (c.rows_valid && !rows_done);
    c.context_valid = load || (c.context_valid && !rows_load);
    c.tag_valid = fetch || (c.tag_valid && !load);
    c.room += (c.freed ? 1 : 0) + (leaving.valid && !leaving.push() ? 1 : 0) - (issue ? 1 : 0);
    c.freed = pop;

    if (stamps.valid())
      ring_tail = stamps.head().tile_ptr;
    else if (stamps.empty())
      ring_tail = leaving.pointer;
    if (leaving.push()) stamps.next() = leaving.stamp;
    stamps.clock(pop, leaving.push());
  }

  /// Computes the head's row and those behind it up to their quad's end.
  void compute_ahead(const TileEntry& tile) {
    Slot& slot = slots[tile.slot];
    ahead.begin();
    for (std::size_t n = 0; n < stamps.words() && !ahead.full(); ++n) {
      const StampEntry& row = stamps.word(n);
      if (row.end) break;
      ahead.add(ring_at(row.tile_ptr), row, slot);
    }
    ahead.compute(slot);
  }

  /// A pixel enters the pipeline.
  void send(Pixel& p, std::size_t lane, std::uint8_t kind, const Fragment& fragment) {
    p.valid = true;
    p.kind = kind;
    ++sent[lane][kind];
    if ((kind & pixel_drawn) == 0) return;
    p.fragment = next_place;
    on_way[next_place] = fragment;
    next_place = (next_place + 1) & static_cast<std::uint32_t>(on_way.size() - 1);
  }

  /// pixel_emit and the pixel pipeline. Returns whether the stamp FIFO's head leaves.
  bool clock_pixels() {
    bool pixel = false, drawn = false;
    for (const Pixel& last : stage(last_stage)) {
      pixel |= last.valid;
      drawn |= last.drawn();
    }
    int places_back = (handed_over ? 1 : 0) + (pixel && !drawn ? 1 : 0);
    const std::size_t next_head = (head + pipeline_registers - 1) % pipeline_registers;
    const std::span<Pixel> entering{&pipeline[next_head * lanes], lanes};
    for (Pixel& p : entering) p.valid = p.end = false;
    bool pop = false;
    if (stamps.valid()) {
      const StampEntry& s = stamps.head();
      const TileEntry& tile = ring_at(s.tile_ptr);
      if (s.end) {
        entering[0].end = true;
        entering[0].slot = tile.slot;
        pop = true;
      } else if (places > 0 && is_homogeneous(tile) && part < latency::homogeneous_parts - 1) {
        ++part;
      } else if (places > 0) {
        part = 0;
        const Slot& slot = slots[tile.slot];
        std::uint32_t mask = first ? s.mask : rest;
        if (traces.empty()) {
          if (ahead.empty()) compute_ahead(tile);
          for (std::size_t lane = 0; lane < lanes && mask != 0; ++lane, mask &= mask - 1, ahead.advance())
            send(entering[lane], lane, ahead.kind(), ahead.fragment());
        } else {
          const TileRow row = forward_difference_row(tile, slot.constants, s.row);
          for (std::size_t lane = 0; lane < lanes && mask != 0; ++lane, mask &= mask - 1) {
            const int dx = std::countr_zero(mask);
            PixelTrace& trace = traces[next_head * lanes + lane];
            trace.front = (s.front >> dx & 1) != 0;
            trace.tie = (s.tie >> dx & 1) != 0;
            pixel_lane(trace, row, slot.constants, slot.data, dx, context);
            send(entering[lane], lane, kind_of(trace), trace.fragment);
          }
        }
        rest = mask;
        pop = rest == 0;
        first = pop;
        --places_back;
      }
    }
    places += places_back;
    head = next_head;
    return pop;
  }

  void clock(const ClockedInputs& in) {
    if (in.reset) {
      reset();
      lane_probes = {};
      return;
    }
    // All conditions first: every unit sees the state before the edge.
    const bool starting = start();
    const bool taking = take();
    const bool dropping = setup.drops();
    const bool dropping_vertices = assembly.drops();
    const bool accept = in.vertex_valid && hidden.wiping == 0 && (!assembly.full || starting || dropping_vertices);
    const bool clearing = in.clear_hidden && !busy();
    std::uint32_t free_slots = 0;
    if (stage(last_stage).front().end) free_slots |= 1u << stage(last_stage).front().slot;
    if (dropping) free_slots |= 1u << setup.dropped().slot;
    const bool push_tile = walk_push();
    const bool walk_moves = push_tile || !walk.way.back().push;
    count(starting, taking, dropping, push_tile, walk_moves);

    // The last register's fragments enter the FIFO in the clock in which the pipeline moves on.
    const bool handing_over = fragments.valid() && in.fragment_ready;
    const std::span<const Pixel> last = stage(last_stage);
    FragmentBeat& beat = fragments.next();
    beat.drawn = 0;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (!last[lane].drawn()) continue;
      beat.drawn |= 1u << lane;
      beat.fragment[lane] = last[lane].fragment;
    }
    fragments.clock(handing_over, beat.drawn != 0);
    const bool pop = clock_pixels();
    handed_over = handing_over;
    clock_stamps(pop);
    const bool units_taken = tile_unit.issues();
    completed = tile_unit.way.back();
    if (completed) {
      last_completed = ring_complete;
      ring_complete = behind(ring_complete);
    }
    const TileEntry& pushed = walk.way.back().entry;
    tile_unit.clock(push_tile ? &pushed : nullptr, is_homogeneous(pushed));
    if (push_tile) {
      ring[ring_write & (ring.size() - 1)] = pushed;
      ring_write = behind(ring_write);
    }
    if (walk_moves) walk.clock();
    hidden.clock(clearing, context.config.hierarchical_z_bits != 0);
    if (taking) {
      const SetupResult& quad = setup.result.setup;
      slots[quad.slot].constants = QuadConstants(quad);
      walk.take(quad, skips_hidden(context.config, context.state) ? &hidden.memory : nullptr, slots[quad.slot].depth);
    }
    // A slot is skipped while it is in use and another is not: quads that setup drops leave theirs before older ones
    // do.
    const bool next_slot = starting || ((in_use >> alloc & 1) != 0 && in_use != (1u << slots.size()) - 1);
    const std::uint32_t slot = alloc;
    if (next_slot) alloc = (alloc + 1) % static_cast<std::uint32_t>(slots.size());
    in_use &= ~free_slots;
    setup.clock(assembly.full && !dropping_vertices, taking, units_taken);
    if (dropping_vertices) assembly.full = false;
    if (starting) {
      SetupResult result = quad_setup(assembly.quad, context.config, context.state);
      result.slot = slot;
      slots[slot].quad = assembly.number;
      slots[slot].depth = depth_interval(assembly.quad, context.config, context.state);
      slots[slot].data = quad_data(assembly.quad, result, context.config, context.state);
      if (traces.empty()) ahead.take(result, slots[slot]);
      setup.start(result, context.state);
      in_use |= 1u << slot;
      assembly.full = false;
    }
    if (starting || dropping_vertices) ++assembly.number;
    if (in.flush) {
      assembly.count = 0;
    } else if (accept) {
      if (assembly.count == 0) {
        assembly.quad.id = in.vertex.id;
        assembly.quad.base = in.vertex.base;
      }
      assembly.quad.vertex[static_cast<std::size_t>(assembly.count)] = in.vertex.vertex;
      assembly.full = assembly.count == 3;
      if (assembly.full) assembly.reject = reject_by_vertices(assembly.quad, context.config, context.state);
      assembly.count = (assembly.count + 1) % 4;
    }
    if (!traces.empty()) show_lanes();
  }

  /// The probes of the pixels, after an edge.
  void show_lanes() {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const auto pixel = [&](int n) {
        const std::size_t at = place(n) + lane;
        return pipeline[at].valid ? &traces[at] : nullptr;
      };
      lane_probes[lane] = {pixel(latency::diff_stage),  pixel(latency::norm_stage),   pixel(latency::root_stage),
                           pixel(latency::ratio_stage), pixel(latency::weight_stage), pixel(latency::sum_stage)};
    }
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

ClockedOutputs ClockedModel::comb() const {
  const Impl& m = *impl_;
  ClockedOutputs out;
  out.vertex_ready = m.hidden.wiping == 0 && (!m.assembly.full || m.start() || m.assembly.drops());
  out.fragment_valid = m.fragments.valid();
  for (std::size_t lane = 0; out.fragment_valid && lane < m.lanes; ++lane)
    if ((m.fragments.head().drawn >> lane & 1) != 0) out.fragment[lane] = &m.on_way[m.fragments.head().fragment[lane]];
  out.busy = m.busy();
  if (m.take()) {
    out.probes.setup = &m.setup.result.setup;
    out.probes.setup_quad = m.slots[m.setup.result.setup.slot].quad;
  }
  if (m.completed) out.probes.tile = &m.ring_at(m.last_completed);
  if (m.coverage.way.back().push()) out.probes.stamp = &m.coverage.way.back().stamp;
  for (const Pixel& p : m.stage(latency::diff_stage)) out.probes.pixels += p.valid ? 1 : 0;
  if (!m.traces.empty()) out.probes.lane = m.lane_probes.data();
  return out;
}

bool ClockedModel::quads_under_way() const { return impl_->quads_under_way(); }

void ClockedModel::set_state(const DrawState& state) {
  if (impl_->quads_under_way()) throw std::logic_error("the draw state cannot change while quads are under way");
  check_draw_state(state, impl_->context.config);
  impl_->count_pixels(impl_->counters);  // by the old state's sums
  impl_->sent = {};
  impl_->context = PipelineContext(Config(impl_->context.config), state);
  impl_->ahead.set_state();
  for (const bool hull : {false, true}) impl_->wanted[hull ? 1 : 0] = WantedSums(impl_->context.config, state, hull);
  impl_->walk.walk = TileWalk(impl_->context.config, state);
}

void ClockedModel::clock(const ClockedInputs& inputs) { impl_->clock(inputs); }
PerformanceCounters ClockedModel::counters() const {
  PerformanceCounters counters = impl_->counters;
  impl_->count_pixels(counters);
  return counters;
}

}  // namespace quadrille
