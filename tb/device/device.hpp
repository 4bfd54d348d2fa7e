// The machine under test as the lockstep loop sees it: pins in, pins out, one clock. The Verilated RTL is one
// implementation (verilated_device.hpp); tests have others, broken on purpose.
#pragma once

#include "model/port/stages.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

namespace quadrille::tb {

/// The device cannot go on: an assertion of the RTL failed, or a waveform could not be written.
struct DeviceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

inline constexpr std::size_t probe_count = static_cast<std::size_t>(Boundary::fragment);  ///< boundaries setup to sum

/// The lanes of the fragment port. Boundaries in front of the pixels have one, the first.
inline constexpr std::size_t most_lanes = Config::most_pixels_per_clock;
/// Vectors of the lanes: 32-bit words, least significant first; null beyond the device's lanes.
using LaneWords = std::array<const std::uint32_t*, most_lanes>;

/// A boundary in this clock. words is null on a device without probes.
struct ProbeSample {
  std::uint32_t valid = 0;  ///< bit g: lane g carries something
  LaneWords words{};
};

/// Everything that leaves the machine in one clock.
struct DeviceSample {
  bool vertex_ready = false, fragment_valid = false, busy = false;
  std::uint32_t fragment_mask = 0;
  LaneWords fragment{};                          ///< the packed fragment_t, zero in a lane without one
  std::array<ProbeSample, probe_count> probe{};  ///< indexed by Boundary
};

class Device {
 public:
  virtual ~Device() = default;

  /// Reset input, active or not; as every input it takes effect at the next settle().
  virtual void set_reset(bool active) = 0;

  /// The packed state_t. To be changed only while no quad is under way: the RTL asserts it.
  virtual void set_state(std::span<const std::uint32_t> words) = 0;

  /// The packed vertex_t of the beat that is offered. It must stay as it is until the beat was taken, or a flush.
  virtual void set_vertex(std::span<const std::uint32_t> words) = 0;

  /// clear_hidden_i and flush_i, at first not active.
  virtual void set_clear_hidden(bool active) = 0;
  virtual void set_flush(bool active) = 0;

  /// vertex_valid_i and fragment_ready_i.
  virtual void set_handshake(bool vertex_valid, bool fragment_ready) = 0;

  /// Lets inputs run through to the outputs with the clock low. May be called again after further changes of the
  /// inputs. Throws DeviceError when the device stopped, on a failed assertion say.
  virtual void settle() = 0;

  /// The outputs after settle(). Pointers in it hold until the next call of settle() or clock().
  virtual const DeviceSample& sample() = 0;

  /// A performance counter by its index (model/port/performance_counters.hpp), after settle(); 0 without them.
  virtual std::uint32_t counter(std::size_t /*index*/) { return 0; }

  /// The rising edge of the clock. Throws DeviceError as settle() does.
  virtual void clock() = 0;
};

}  // namespace quadrille::tb
