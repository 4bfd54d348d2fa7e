#include "tb/device/verilated_device.hpp"

#include "model/port/bit_vector.hpp"
#include "tb/device/device_abi.h"
#include "tb/support/environment_error.hpp"

#include <dlfcn.h>

#include <algorithm>

namespace quadrille::tb {

static_assert(probe_count == quadrille_probe_count && most_lanes == quadrille_most_lanes);

namespace {

/// A shared object. It stays in memory after the scope: Verilator's run time keeps a buffer per thread that nobody else
/// frees.
class Library {
 public:
  explicit Library(const std::filesystem::path& file)
      : handle_(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE)) {
    if (handle_ == nullptr) throw SystemError("cannot load " + file.string() + ": " + dlerror());
  }
  ~Library() { dlclose(handle_); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  const quadrille_device_table* table(const std::filesystem::path& file) const {
    const auto function = reinterpret_cast<quadrille_device_api_function>(dlsym(handle_, "quadrille_device_api"));
    const quadrille_device_table* found = function == nullptr ? nullptr : function();
    if (found == nullptr || found->abi_version != quadrille_device_abi_version) {
      throw SystemError(file.string() + " is not a device of this program; run `quadrille cache clear`");
    }
    return found;
  }

 private:
  void* handle_;
};

}  // namespace

struct VerilatedDevice::Impl {
  CacheEntry in_use;
  Library library;
  const quadrille_device_table* table;
  quadrille_device* device;
  DeviceSample sample;

  Impl(const Simulator& simulator, std::uint64_t seed)
      : in_use(simulator.entry),
        library(simulator.object()),
        table(library.table(simulator.object())),
        device(table->create(seed)) {
    if (device == nullptr) throw DeviceError(std::string("cannot set up the RTL: ") + table->last_error(nullptr));
  }
  ~Impl() { table->destroy(device); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void check(int status) const {
    if (status == quadrille_no_waveform) throw SystemError(table->last_error(device));
    if (status != 0) throw DeviceError(table->last_error(device));
  }
};

VerilatedDevice::VerilatedDevice(const Config& config, const VerilateOptions& options, std::uint64_t seed)
    : VerilatedDevice(verilate(config, options), config, seed) {}

VerilatedDevice::VerilatedDevice(const Simulator& simulator, const Config& config, std::uint64_t seed)
    : impl_(std::make_unique<Impl>(simulator, seed)) {
  // The layouts of both sides must have the same number of bits before a single one is compared.
  const auto same = [](const char* what, std::uint32_t rtl, int cpp) {
    if (rtl != static_cast<std::uint32_t>(cpp)) {
      throw DeviceError(std::string("port ") + what + " has " + std::to_string(rtl) + " bits in the RTL and " +
                        std::to_string(cpp) + " in the model");
    }
  };
  const quadrille_sample& s = *impl_->table->sample(impl_->device);
  same("vertex", impl_->table->vertex_width, vertex_layout(config).bits());
  same("state", impl_->table->state_width, state_layout(config).bits());
  same("fragment", s.fragment_width, boundary_layout(Boundary::fragment, config).bits());
  for (std::size_t i = 0; i < probe_count; ++i) {
    const auto b = static_cast<Boundary>(i);
    if (s.probe[i].width != 0) same(boundary_name(b), s.probe[i].width, boundary_layout(b, config).bits());
    std::copy_n(s.probe[i].words, most_lanes, impl_->sample.probe[i].words.begin());
  }
  std::copy_n(s.fragment_words, most_lanes, impl_->sample.fragment.begin());
}

VerilatedDevice::~VerilatedDevice() = default;

void VerilatedDevice::set_reset(bool active) { impl_->table->set_reset(impl_->device, active); }
void VerilatedDevice::set_state(std::span<const std::uint32_t> words) {
  impl_->table->set_state(impl_->device, words.data());
}
void VerilatedDevice::set_vertex(std::span<const std::uint32_t> words) {
  impl_->table->set_vertex(impl_->device, words.data());
}
void VerilatedDevice::set_clear_hidden(bool active) { impl_->table->set_clear_hidden(impl_->device, active ? 1 : 0); }
void VerilatedDevice::set_flush(bool active) { impl_->table->set_flush(impl_->device, active ? 1 : 0); }

void VerilatedDevice::set_handshake(bool vertex_valid, bool fragment_ready) {
  impl_->table->set_handshake(impl_->device, vertex_valid, fragment_ready);
}
void VerilatedDevice::settle() { impl_->check(impl_->table->settle(impl_->device)); }
void VerilatedDevice::clock() { impl_->check(impl_->table->clock(impl_->device)); }
std::uint32_t VerilatedDevice::counter(std::size_t index) {
  return impl_->table->counter(impl_->device, static_cast<std::uint32_t>(index));
}

const DeviceSample& VerilatedDevice::sample() {
  const quadrille_sample& s = *impl_->table->sample(impl_->device);
  DeviceSample& out = impl_->sample;
  out.vertex_ready = s.vertex_ready != 0;
  out.fragment_valid = s.fragment_valid != 0;
  out.busy = s.busy != 0;
  out.fragment_mask = s.fragment_mask;
  for (std::size_t i = 0; i < probe_count; ++i) out.probe[i].valid = s.probe[i].valid;
  return out;
}

void VerilatedDevice::open_trace(const std::filesystem::path& file) {
  impl_->check(impl_->table->trace_open(impl_->device, file.c_str()));
}

void VerilatedDevice::close_trace() { impl_->check(impl_->table->trace_close(impl_->device)); }

std::vector<std::pair<std::string, std::int64_t>> VerilatedDevice::constants() const {
  std::vector<std::pair<std::string, std::int64_t>> list;
  for (const quadrille_constant* c = impl_->table->constants(); c->name != nullptr; ++c)
    list.emplace_back(c->name, c->value);
  return list;
}

}  // namespace quadrille::tb
