// Compares the machine under test with the clocked model, clock by clock, at the ports and at every stage boundary.
#pragma once

#include "model/clocked.hpp"
#include "model/port/bit_vector.hpp"
#include "model/port/config.hpp"
#include "tb/device/device.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::tb {

/// What was compared at one boundary.
struct BoundaryCount {
  std::string name;
  std::uint64_t beats = 0;       ///< payloads that were there on both sides and were compared
  std::uint64_t bits = 0;        ///< payload bits compared
  std::uint64_t mismatches = 0;  ///< beats that differ
};

/// The pixel of a quad that a difference is about.
struct DivergentPixel {
  std::uint32_t quad = 0;  ///< its id
  int x = 0, y = 0;
};

class Scoreboard {
 public:
  /// `probes`: compare the boundaries setup to sum too. `quads` (for messages) must outlive the scoreboard.
  Scoreboard(const Config& config, std::span<const SnappedQuad> quads, bool probes, std::uint64_t seed);

  /// The draw follows that of `before` in one machine: slots and ring pointers go on.
  void follows(const Scoreboard& before);

  struct Verdict {
    bool timing = true;    ///< every valid, ready, busy and mask agrees
    bool payload = true;   ///< every payload agrees
    bool fragment = true;  ///< the fragment's bits agree
  };

  /// Both sides settled in clock `cycle`.
  Verdict compare(std::uint64_t cycle, const ClockedOutputs& expected, const DeviceSample& actual);

  /// At the end of a run, both sides settled in clock `cycle`: each counter that differs is a mismatch.
  void compare_counters(std::uint64_t cycle, const PerformanceCounters& expected, Device& actual);

  /// The device stopped by itself (an assertion).
  void device_stopped(std::uint64_t cycle, const std::string& why);

  std::uint64_t mismatches() const { return mismatches_; }
  std::uint64_t cycle_mismatches() const { return cycle_mismatches_; }
  const std::optional<std::string>& first_divergence() const { return first_; }
  /// Where it is about one.
  const std::optional<DivergentPixel>& first_pixel() const { return first_pixel_; }
  const std::vector<BoundaryCount>& counts() const { return counts_; }

 private:
  /// Quad and pixel that a difference is about.
  struct Place {
    const SnappedQuad* quad = nullptr;
    int x = -1, y = -1;
    std::string_view unit = "pixel";
    int lane = -1;  ///< none: of all lanes, or of a machine with one
  };
  struct RingPlace {
    std::size_t quad = 0;
    int tile_x = 0, tile_y = 0;
  };

  template <class Record, class Pack, class Locate>
  void boundary(Boundary b, std::size_t lane, const Record* expected, const ProbeSample& actual, Pack&& pack,
                Locate&& locate);
  template <class Locate>
  void signal(const char* name, std::uint32_t expected, std::uint32_t actual, Locate&& locate);
  void payload_differs(Boundary b, const std::uint32_t* actual, const Place& place);
  /// Of the first difference; keeps its pixel.
  std::string where(const Place& place);
  int lane_to_name(std::size_t lane) const { return config_.pixels_per_clock > 1 ? static_cast<int>(lane) : -1; }
  /// Of a quad of an earlier draw nothing is known.
  const SnappedQuad* quad_at(std::size_t ordinal) const {
    return ordinal >= quads_before_ && ordinal - quads_before_ < quads_.size() ? &quads_[ordinal - quads_before_]
                                                                               : nullptr;
  }
  void follow(const ClockedProbes& probes);

  const Config config_;
  std::span<const SnappedQuad> quads_;
  std::size_t quads_before_ = 0;  ///< of earlier draws since the reset
  bool probes_;
  std::uint64_t seed_;
  std::size_t lanes_;
  std::vector<RecordLayout> layouts_;  // by Boundary
  std::vector<std::uint64_t> packed_;  // room for the widest boundary
  std::vector<BoundaryCount> counts_;  // by Boundary

  std::uint64_t cycle_ = 0, mismatches_ = 0, cycle_mismatches_ = 0;
  Verdict verdict_;
  std::optional<std::string> first_;
  std::optional<DivergentPixel> first_pixel_;

  // Which quad and tile a slot or a ring pointer stands for.
  std::vector<std::size_t> quad_of_slot_;
  std::vector<RingPlace> ring_;
  std::size_t ring_write_ = 0;
};

}  // namespace quadrille::tb
