// The C side of quadrille_dpi_pkg.sv: the stage suites of the golden vectors behind DPI-C. No arithmetic and no packing
// of its own.
//
// Types are those that IEEE 1800-2017 annex H maps int, string, chandle and bit vectors to: svBitVecVal is a 32-bit
// word, least significant word first.
#include "golden/vectors/stage_suite.hpp"
#include "golden/vectors/suite.hpp"
#include "model/port/config_text.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace quadrille::vectors {
namespace {

constexpr int record_bits = 4096;  ///< RECORD_BITS of the package
constexpr int record_words = record_bits / 32;

/// status_t of the package.
enum Status { ok = 0, bad_config = 1, bad_name = 2, bad_stimulus = 3, bad_model = 4, failed = 5 };

struct Failure {
  Status status;
  std::string text;
};

thread_local std::string last_error;

/// A stage and what it may be given.
struct Entry {
  explicit Entry(std::unique_ptr<const StageUnderTest> s) : stage(std::move(s)), check(*stage) {}

  std::unique_ptr<const StageUnderTest> stage;
  StimulusCheck check;
};

/// One configuration and its stages by suite; constant once it is made.
struct Model {
  explicit Model(const Config& c) : config(c) {
    for (const auto& suite : suites())
      if (const auto* staged = dynamic_cast<const StageSuite*>(suite.get()))
        entries.emplace(staged->info().name, staged->stage(config));
  }

  Config config;
  std::map<std::string, Entry, std::less<>> entries;
};

/// Runs `body` with every exception turned into a status and a text.
template <class F>
int guarded(F&& body) {
  try {
    body();
    return ok;
  } catch (const Failure& f) {
    last_error = f.text;
    return f.status;
  } catch (const ConfigError& e) {
    last_error = e.what();
    return bad_config;
  } catch (const std::exception& e) {
    last_error = e.what();
    return failed;
  }
}

std::string_view view(const char* text) { return text == nullptr ? std::string_view() : std::string_view(text); }

std::string quoted(std::string_view name) { return "\"" + std::string(name) + "\""; }

const Model& checked(const void* model) {
  if (model == nullptr) throw Failure{bad_model, "the model is null; quadrille_open() gives one"};
  return *static_cast<const Model*>(model);
}

const Entry& entry_of(const Model& model, std::string_view suite) {
  const auto found = model.entries.find(suite);
  if (found != model.entries.end()) return found->second;
  std::string known;
  for (const auto& [name, entry] : model.entries) known += (known.empty() ? "" : ", ") + name;
  throw Failure{bad_name, "no stage suite " + quoted(suite) + "; there are " + known};
}

void find_field(const RecordLayout& layout, std::string_view suite, std::string_view name, int index, int* position,
                int* width) {
  for (const RecordField& field : layout.fields()) {
    if (field.name != name || field.index != index) continue;
    *position = field.position;
    *width = field.width;
    return;
  }
  throw Failure{bad_name, "suite " + quoted(suite) + ": no field " + quoted(name) + " with index " +
                              std::to_string(index) + " in this record"};
}

int value_of(const Config& config, std::string_view name) {
  if (const std::optional<int> value = config_number(config, name)) return *value;
  throw Failure{bad_name, "no key and no derived width " + quoted(name) + "; `quadrille config` lists them"};
}

/// The record in the low bits of a record_t.
Record record_from(const std::uint32_t* words, int bits, std::string_view suite) {
  Record record(bits);
  for (int i = 0; i < record_words; ++i) {
    const int width = std::clamp(bits - 32 * i, 0, 32);
    if (width < 32 && words[i] >> width != 0)
      throw Failure{bad_stimulus, "suite " + quoted(suite) + ": the stimulus has " + std::to_string(bits) +
                                      " bits, but a bit above them is set"};
    if (width > 0) record.set(32 * i, width, words[i]);
  }
  return record;
}

void respond(const void* model, std::string_view suite, const std::uint32_t* stimulus, std::uint32_t* response) {
  std::fill_n(response, record_words, 0);
  const Entry& entry = entry_of(checked(model), suite);
  const Record in = record_from(stimulus, entry.stage->stimulus_layout().bits(), suite);
  if (const std::string fault = entry.check.fault(in); !fault.empty())
    throw Failure{bad_stimulus, "suite " + quoted(suite) + ": " + fault};
  const Record out = entry.stage->respond(in);
  for (int i = 0; 32 * i < out.bits(); ++i)
    response[i] = static_cast<std::uint32_t>(out.get(32 * i, std::min(32, out.bits() - 32 * i)));
}

}  // namespace
}  // namespace quadrille::vectors

// ---- The imported functions
// --------------------------------------------------------------------------------------------

#define QUADRILLE_EXPORT extern "C" [[gnu::visibility("default")]]

namespace vectors = quadrille::vectors;

QUADRILLE_EXPORT int quadrille_open(const char* settings, void** model) {
  *model = nullptr;
  return vectors::guarded([&] {
    quadrille::Config config;
    quadrille::apply_config_text(vectors::view(settings), config);
    *model = new vectors::Model(config);
  });
}

QUADRILLE_EXPORT void quadrille_close(void* model) { delete static_cast<vectors::Model*>(model); }

QUADRILLE_EXPORT const char* quadrille_error() { return vectors::last_error.c_str(); }

QUADRILLE_EXPORT int quadrille_value(void* model, const char* name, int* value) {
  *value = 0;
  return vectors::guarded([&] { *value = vectors::value_of(vectors::checked(model).config, vectors::view(name)); });
}

QUADRILLE_EXPORT int quadrille_record_bits(void* model, const char* suite, int* stimulus_bits, int* response_bits) {
  *stimulus_bits = *response_bits = 0;
  return vectors::guarded([&] {
    const vectors::Entry& entry = vectors::entry_of(vectors::checked(model), vectors::view(suite));
    *stimulus_bits = entry.stage->stimulus_layout().bits();
    *response_bits = entry.stage->response_layout().bits();
  });
}

QUADRILLE_EXPORT int quadrille_stimulus_field(void* model, const char* suite, const char* name, int index,
                                              int* position, int* width) {
  *position = *width = 0;
  return vectors::guarded([&] {
    const vectors::Entry& entry = vectors::entry_of(vectors::checked(model), vectors::view(suite));
    vectors::find_field(entry.stage->stimulus_layout(), vectors::view(suite), vectors::view(name), index, position,
                        width);
  });
}

QUADRILLE_EXPORT int quadrille_response_field(void* model, const char* suite, const char* name, int index,
                                              int* position, int* width) {
  *position = *width = 0;
  return vectors::guarded([&] {
    const vectors::Entry& entry = vectors::entry_of(vectors::checked(model), vectors::view(suite));
    vectors::find_field(entry.stage->response_layout(), vectors::view(suite), vectors::view(name), index, position,
                        width);
  });
}

QUADRILLE_EXPORT int quadrille_respond(void* model, const char* suite, const std::uint32_t* stimulus,
                                       std::uint32_t* response) {
  return vectors::guarded([&] { vectors::respond(model, vectors::view(suite), stimulus, response); });
}

// A function a stage: quadrille_respond() with its suite.
#define QUADRILLE_STAGE(function, suite)                                                               \
  QUADRILLE_EXPORT int function(void* model, const std::uint32_t* stimulus, std::uint32_t* response) { \
    return quadrille_respond(model, suite, stimulus, response);                                        \
  }

QUADRILLE_STAGE(quadrille_snap, "snapping")
QUADRILLE_STAGE(quadrille_quad_setup, "setup")
QUADRILLE_STAGE(quadrille_tile_context, "tile_context")
QUADRILLE_STAGE(quadrille_stamp_coverage, "coverage")
QUADRILLE_STAGE(quadrille_forward_difference, "forward_difference")
QUADRILLE_STAGE(quadrille_normalise, "normalise")
QUADRILLE_STAGE(quadrille_sqrt, "sqrt")
QUADRILLE_STAGE(quadrille_reciprocal, "reciprocal")
QUADRILLE_STAGE(quadrille_mean_value_ratios, "ratios")
QUADRILLE_STAGE(quadrille_mean_value_weights, "weights")
QUADRILLE_STAGE(quadrille_interpolate, "interpolation")
QUADRILLE_STAGE(quadrille_fragment_output, "depth")
