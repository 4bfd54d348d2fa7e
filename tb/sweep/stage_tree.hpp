// A batch of configurations as a tree of stages, and its walk: each node executes its stage once per chunk of the
// input, whatever hangs below it.
#pragma once

#include "tb/sweep/plane_quads.hpp"
#include "tb/sweep/port_quads.hpp"
#include "tb/sweep/stage_keys.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace quadrille::sweep {

/// What a leaf adds up over chunks; merging does not depend on the order.
struct LeafTotals {
  std::uint64_t fragments = 0, drawn_as_given = 0, discard_differs = 0, colour_codes = 0, saturated = 0;
  std::uint64_t plane_fragments = 0;  ///< drawn with areas for weights
  OutputStats arithmetic;
  WorstPixel worst;

  void merge(const LeafTotals& other);
};

struct PlaneNode {
  LevelKey key;
  std::shared_ptr<const PlaneQuads> quads;  ///< none: all quads have mean value weights
  std::size_t leaf;                         ///< number in the tree
  std::vector<std::size_t> points;          ///< that end here
};
struct ReciprocalNode {
  LevelKey key;
  std::shared_ptr<const LaneTable> table;
  std::vector<PlaneNode> planes;

  bool takes_quads() const;  ///< some point here
};
struct InterpolateNode {
  LevelKey key;
  std::size_t port;  ///< in the ports of the NormaliseNode above
  std::vector<ReciprocalNode> reciprocals;
};
struct RatioNode {
  LevelKey key;
  int align_guard_bits;
  std::vector<InterpolateNode> interpolates;
};
struct SqrtNode {
  LevelKey key;
  std::shared_ptr<const LaneTable> table;
  std::shared_ptr<const PipelineContext> context;  ///< with these bits and table; for singular pixels
  std::vector<RatioNode> ratios;
};
/// Quads at the port with outputs of one format, and the truth on them: of use to every InterpolateNode of that key
/// below one NormaliseNode.
struct PortNode {
  LevelKey key;
  std::shared_ptr<const PortQuads> quads;
  LaneOutputFormat format;
};
struct NormaliseNode {
  LevelKey key;
  int significand_bits;
  std::vector<PortNode> ports;      ///< at least one; X, Y, W, k are the same in all
  std::vector<std::uint8_t> areas;  ///< by quad, 1: taken by some point below; empty: none is
  std::vector<SqrtNode> sqrts;
};

/// Tables that a tree needs, kept for the next one.
class TableCache {
 public:
  /// Throw ConfigError when a coefficient does not fit.
  std::shared_ptr<const LaneTable> sqrt(const Config& config);
  std::shared_ptr<const LaneTable> recip(const Config& config);
  std::shared_ptr<const PipelineContext> context(const Config& config, const DrawState& state);

 private:
  template <class T>
  struct Entry {
    LevelKey key;
    std::shared_ptr<const T> value;
  };
  std::vector<Entry<LaneTable>> sqrt_, recip_;
  std::vector<Entry<PipelineContext>> context_;
};

/// The tree of points that share a DifferenceData.
class StageTree {
 public:
  StageTree(const SweepInput& input, std::shared_ptr<const PositionData> positions,
            std::shared_ptr<const DifferenceData> differences);

  /// Adds a point; `port` is called when its port_key() is new, `planes` when it is a leaf of its own and may
  /// take quads (it gives none where it does not).
  void add(std::size_t point, const Config& config, TableCache& tables,
           const std::function<std::shared_ptr<const PortQuads>()>& port,
           const std::function<std::shared_ptr<const PlaneQuads>()>& planes);

  std::size_t leaves() const { return leaves_; }
  std::size_t chunks() const;

  /// Buffers of one thread, and what it has added up.
  struct Truth;
  struct Weighted;
  struct Scratch;
  struct ScratchDeleter {
    void operator()(Scratch* scratch) const;
  };
  using ScratchPointer = std::unique_ptr<Scratch, ScratchDeleter>;
  ScratchPointer make_scratch() const;
  /// Runs every node over one chunk. `map` (may be empty) gets the |Δλ'| of each lane of the input, −1 where the
  /// machine draws nothing; for a tree of one leaf.
  void walk(std::size_t chunk, Scratch& scratch, std::span<float> map = {}) const;
  static const LeafTotals& totals(const Scratch& scratch, std::size_t leaf);

  /// What a walk over all chunks executed, from normalise on.
  StageCounters executed() const;
  /// Calls f(leaf node, its PortQuads) for every leaf.
  void for_each_leaf(const std::function<void(const PlaneNode&, const PortQuads&)>& f) const;

 private:
  /// Replaces the weights of the singular lanes of a chunk.
  void singular_pixels(const NormaliseNode& normalise, const SqrtNode& sqrt, const RatioNode& ratio, std::size_t first,
                       std::size_t count, Scratch& scratch) const;
  /// Blocks of a chunk, neighbours, whose quads some point draws with areas.
  struct Run {
    std::size_t first, count;
  };
  std::vector<Run> area_runs(const NormaliseNode& normalise, std::size_t first, std::size_t count) const;
  /// Areas for weights in a run of the chunk whose first block is `first`; after the mean value weights.
  void area_weights(const Run& run, std::size_t first, Scratch& scratch) const;
  /// A leaf's output at a chunk against the truth. `areas` (may be null): the quads whose own attributes and depth are
  /// those with areas for weights.
  void compare(LeafTotals& leaf, const PlaneQuads* areas, const Truth& truth, std::size_t first, std::size_t count,
               const Scratch& scratch, std::span<float> map) const;

  const SweepInput& input_;
  Columns columns_;
  std::shared_ptr<const PositionData> positions_;
  std::shared_ptr<const DifferenceData> differences_;
  std::vector<NormaliseNode> roots_;
  std::size_t leaves_ = 0;
};

}  // namespace quadrille::sweep
