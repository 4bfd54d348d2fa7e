// Compiled together with the Verilated class of one configuration; the other side of device_abi.h. Widths differ
// between configurations, so a port may be a byte, a word or an array of words: everything goes through the templates
// below.
#include "Vquadrille.h"
#include "device_abi.h"
#include "verilated.h"
#if VM_COVERAGE
#include "verilated_cov.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#endif
#if QUADRILLE_TRACE
#include "verilated_fst_c.h"
extern "C" {
thread_local int quadrille_trace_error = 0;  // set by device_trace.h
}
#endif

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "device_constants.inc"  // widths, quadrille_constants[], QUADRILLE_FOR_EACH_PROBE(f): f(index, name, lanes)

namespace {

// ---- ports of any width ----

template <class T>
struct PortTraits {
  static constexpr unsigned words = (sizeof(T) + 3) / 4;
  static constexpr bool wide = false;
};
template <std::size_t N>
struct PortTraits<VlWide<N>> {
  static constexpr unsigned words = N;
  static constexpr bool wide = true;
};

template <class T>
void assign(T& port, const uint32_t* words) {
  if constexpr (PortTraits<T>::wide) {
    std::memcpy(port.data(), words, sizeof(uint32_t) * PortTraits<T>::words);
  } else {
    uint64_t value = words[0];
    if constexpr (PortTraits<T>::words > 1) value |= static_cast<uint64_t>(words[1]) << 32;
    port = static_cast<T>(value);
  }
}

/// Words of the lanes of an output port, lane 0 in its lowest bits. A wide port with one lane is read where it lies,
/// any other is copied by refresh().
struct LaneCopy {
  uint32_t width = 0;  ///< bits of a lane
  uint32_t lanes = 0;  ///< 0: nothing to copy
  std::vector<uint32_t> words;
};

constexpr uint32_t words_of(uint32_t bits) { return (bits + 31) / 32; }

/// `bits`: of the port, all lanes together.
template <class T>
void bind(const T& port, uint32_t bits, uint32_t lanes, uint32_t& width, const uint32_t** words, LaneCopy& copy) {
  width = bits / lanes;
  if constexpr (PortTraits<T>::wide) {
    if (lanes == 1) {
      words[0] = port.data();
      return;
    }
  }
  copy.width = width;
  copy.lanes = lanes;
  copy.words.resize(lanes * words_of(width));
  for (uint32_t lane = 0; lane < lanes; ++lane) words[lane] = &copy.words[lane * words_of(width)];
}

template <class T>
void refresh(const T& port, LaneCopy& copy) {
  if (copy.lanes == 0) return;
  uint32_t narrow[2] = {0, 0};
  const uint32_t* from = narrow;
  if constexpr (PortTraits<T>::wide) {
    from = port.data();
  } else {
    narrow[0] = static_cast<uint32_t>(port);
    if constexpr (PortTraits<T>::words > 1) narrow[1] = static_cast<uint32_t>(static_cast<uint64_t>(port) >> 32);
  }
  uint32_t* to = copy.words.data();
  for (uint32_t lane = 0; lane < copy.lanes; ++lane) {
    for (uint32_t bit = 0; bit < copy.width; bit += 32) {
      const uint32_t at = lane * copy.width + bit, low = at % 32, count = std::min(32u, copy.width - bit);
      uint64_t two = from[at / 32];
      if (low + count > 32) two |= static_cast<uint64_t>(from[at / 32 + 1]) << 32;
      *to++ = static_cast<uint32_t>(two >> low) & (count == 32 ? ~0u : (1u << count) - 1);
    }
  }
}

std::string create_error;
/// What $display and failing assertions print; the host's standard output belongs to reports.
thread_local std::string printed;

}  // namespace

// ---- what Verilator's run time calls ----

extern "C" int quadrille_device_print(const char* format, ...) {
  char text[2048];
  va_list arguments;
  va_start(arguments, format);
  const int n = std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  if (printed.size() < 16384) printed += text;
  return n;
}

void vl_finish(const char* file, int line, const char*) {
  throw std::runtime_error("$finish at " + std::string(file) + ":" + std::to_string(line));
}
void vl_stop(const char* file, int line, const char*) {
  throw std::runtime_error("assertion or $stop at " + std::string(file) + ":" + std::to_string(line) + "\n" + printed);
}
void vl_fatal(const char* file, int line, const char*, const char* message) {
  throw std::runtime_error("$fatal at " + std::string(file) + ":" + std::to_string(line) + ": " + message + "\n" +
                           printed);
}

struct quadrille_device {
  std::unique_ptr<VerilatedContext> context = std::make_unique<VerilatedContext>();
  std::unique_ptr<Vquadrille> top;
#if QUADRILLE_TRACE
  std::unique_ptr<VerilatedFstC> trace;
#endif
  quadrille_sample sample{};
  LaneCopy fragment_copy;
  LaneCopy probe_copy[quadrille_probe_count];
  std::string error;

  int dump() {
#if QUADRILLE_TRACE
    if (trace) trace->dump(context->time());
    if (int status = trace_status()) return status;
#endif
    context->timeInc(1);
    return 0;
  }
#if QUADRILLE_TRACE
  int trace_status() {
    if (quadrille_trace_error == 0) return 0;
    error = std::string("the waveform cannot be written: ") + std::strerror(quadrille_trace_error);
    return quadrille_no_waveform;
  }
#endif

  /// Evaluates; 0, or another status with the error kept.
  int evaluate(uint8_t clock) {
    if (!error.empty()) return 1;
    try {
      printed.clear();
      Verilated::threadContextp(context.get());
      top->clk_i = clock;
      top->eval();
      return dump();
    } catch (const std::exception& failure) {
      error = failure.what();
      return 1;
    }
  }
};

namespace {

quadrille_device* create(uint64_t seed) {
  try {
    auto device = std::make_unique<quadrille_device>();
    Verilated::threadContextp(device->context.get());
    device->context->threads(1);
#if VM_COVERAGE
    device->context->randReset(0);  // a constant behind a random start would look like a bit that changes
#else
    device->context->randReset(2);
#endif
    device->context->randSeed(static_cast<int>((seed ^ (seed >> 32)) & 0x7fffffff) | 1);
#if QUADRILLE_TRACE
    device->context->traceEverOn(true);
#endif
    device->top = std::make_unique<Vquadrille>(device->context.get(), "quadrille");
    Vquadrille& top = *device->top;
    top.clear_hidden_i = 0;
    top.flush_i = 0;
    quadrille_sample& s = device->sample;
    constexpr uint32_t lanes = QUADRILLE_WIDTH_fragment_mask;
    static_assert(lanes <= quadrille_most_lanes);
    bind(top.fragment_o, QUADRILLE_WIDTH_fragment, lanes, s.fragment_width, s.fragment_words, device->fragment_copy);
#ifdef QUADRILLE_PROBES
#define QUADRILLE_BIND(i, name, lanes) \
  bind(top.probe_##name##_o, QUADRILLE_WIDTH_##name, lanes, s.probe[i].width, s.probe[i].words, device->probe_copy[i]);
    QUADRILLE_FOR_EACH_PROBE(QUADRILLE_BIND)
#undef QUADRILLE_BIND
#endif
    return device.release();
  } catch (const std::exception& failure) {
    create_error = failure.what();
    return nullptr;
  }
}

#if VM_COVERAGE
/// Writes what the device counted to a file of its own in $QUADRILLE_COVERAGE_DIR (scripts/coverage.sh).
void write_coverage(quadrille_device* d) {
  const char* directory = std::getenv("QUADRILLE_COVERAGE_DIR");
  if (directory == nullptr) return;
  std::string part = std::string(directory) + "/part-XXXXXX";
  const int file = mkstemp(part.data());  // many processes and devices write at a time
  if (file >= 0) {
    close(file);
    d->context->coveragep()->forcePerInstance(true);  // a bit has to be seen at both values in one place
    d->context->coveragep()->write(part.c_str());
  }
  // A process may be killed meanwhile, by a test say: what has the name of counts is whole.
  const std::string whole = std::string(directory) + "/rtl-" + part.substr(part.size() - 6);
  if (file < 0 || std::rename(part.c_str(), whole.c_str()) != 0) {
    std::perror(part.c_str());
    std::abort();  // a count that is lost would look like a hole
  }
}
#endif

void destroy(quadrille_device* d) {
  // Verilator's destructors ask the thread for its context, which may be that of another device, gone already.
  Verilated::threadContextp(d->context.get());
#if QUADRILLE_TRACE
  if (d->trace) d->trace->close();
#endif
  try {
    d->top->final();
  } catch (const std::exception&) {  // a machine that stopped on an assertion may complain once more
  }
#if VM_COVERAGE
  write_coverage(d);
#endif
  d->top.reset();
  delete d;
}

const quadrille_sample* sample(quadrille_device* d) {
  const Vquadrille& top = *d->top;
  quadrille_sample& s = d->sample;
  s.vertex_ready = top.vertex_ready_o;
  s.fragment_valid = top.fragment_valid_o;
  s.fragment_mask = top.fragment_mask_o;
  s.busy = top.busy_o;
  refresh(top.fragment_o, d->fragment_copy);
#ifdef QUADRILLE_PROBES
#define QUADRILLE_REFRESH(i, name, lanes)        \
  s.probe[i].valid = top.probe_##name##_valid_o; \
  refresh(top.probe_##name##_o, d->probe_copy[i]);
  QUADRILLE_FOR_EACH_PROBE(QUADRILLE_REFRESH)
#undef QUADRILLE_REFRESH
#endif
  return &s;
}

int trace_open([[maybe_unused]] quadrille_device* d, [[maybe_unused]] const char* path) {
#if QUADRILLE_TRACE
  quadrille_trace_error = 0;
  d->trace = std::make_unique<VerilatedFstC>();
  Verilated::threadContextp(d->context.get());
  d->top->trace(d->trace.get(), 99);
  d->trace->open(path);
  if (d->trace->isOpen()) return d->trace_status();
  d->trace.reset();
  d->error = std::string("cannot write ") + path;
#else
  d->error = "this object was built without tracing";
#endif
  return quadrille_no_waveform;
}

int trace_close([[maybe_unused]] quadrille_device* d) {
#if QUADRILLE_TRACE
  if (!d->trace) return 0;
  Verilated::threadContextp(d->context.get());
  d->trace->close();
  d->trace.reset();
  return d->trace_status();
#else
  return 0;
#endif
}

const quadrille_device_table table = {
    .abi_version = quadrille_device_abi_version,
    .vertex_width = QUADRILLE_WIDTH_vertex,
    .state_width = QUADRILLE_WIDTH_state,
    .create = create,
    .destroy = destroy,
    .set_reset = [](quadrille_device* d, int active) { d->top->rst_ni = active ? 0 : 1; },
    .set_state = [](quadrille_device* d, const uint32_t* words) { assign(d->top->state_i, words); },
    .set_vertex = [](quadrille_device* d, const uint32_t* words) { assign(d->top->vertex_i, words); },
    .set_clear_hidden = [](quadrille_device* d, int active) { d->top->clear_hidden_i = active ? 1 : 0; },
    .set_flush = [](quadrille_device* d, int active) { d->top->flush_i = active ? 1 : 0; },
    .set_handshake =
        [](quadrille_device* d, int vertex_valid, int fragment_ready) {
          d->top->vertex_valid_i = static_cast<CData>(vertex_valid);
          d->top->fragment_ready_i = static_cast<CData>(fragment_ready);
        },
    .settle = [](quadrille_device* d) { return d->evaluate(0); },
    .clock = [](quadrille_device* d) { return d->evaluate(1); },
    .counter =
        [](quadrille_device* d, uint32_t index) {
          Verilated::threadContextp(d->context.get());
          d->top->counter_index_i = static_cast<CData>(index);
          d->top->eval();  // a read is no time of the waveform
          return static_cast<uint32_t>(d->top->counter_o);
        },
    .sample = sample,
    .trace_open = trace_open,
    .trace_close = trace_close,
    .constants = [] { return quadrille_constants; },
    .last_error = [](const quadrille_device* d) { return d ? d->error.c_str() : create_error.c_str(); },
};

}  // namespace

extern "C" __attribute__((visibility("default"))) const quadrille_device_table* quadrille_device_api() {
  return &table;
}
