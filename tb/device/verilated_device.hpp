// A Verilated configuration, loaded at run time: neither the program nor the model links Verilator.
#pragma once

#include "model/port/config.hpp"
#include "tb/device/device.hpp"
#include "tb/device/verilate.hpp"

#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

namespace quadrille::tb {

class VerilatedDevice final : public Device {
 public:
  /// Verilates (or finds in the cache) and loads the machine. Registers start with random bits from `seed`.
  /// Throws what verilate() throws, and DeviceError when the RTL's ports do not have the widths that `config` says.
  VerilatedDevice(const Config& config, const VerilateOptions& options, std::uint64_t seed);
  /// Loads what verilate() made for `config`: to be preferred when there are to be several machines.
  VerilatedDevice(const Simulator& simulator, const Config& config, std::uint64_t seed);
  ~VerilatedDevice() override;
  VerilatedDevice(VerilatedDevice&&) = delete;

  void set_reset(bool active) override;
  void set_state(std::span<const std::uint32_t> words) override;
  void set_vertex(std::span<const std::uint32_t> words) override;
  void set_clear_hidden(bool active) override;
  void set_flush(bool active) override;
  void set_handshake(bool vertex_valid, bool fragment_ready) override;
  void settle() override;
  const DeviceSample& sample() override;
  void clock() override;
  std::uint32_t counter(std::size_t index) override;

  /// Writes an FST waveform from now on; needs VerilateOptions::trace. Throws SystemError when it cannot be
  /// written, as settle(), clock() and close_trace() do then; only after close_trace() is the file whole.
  void open_trace(const std::filesystem::path& file);
  void close_trace();

  /// The localparams of quadrille_pkg by name, as the RTL computed them. Empty for Verilog that Yosys wrote.
  std::vector<std::pair<std::string, std::int64_t>> constants() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace quadrille::tb
