// What the tests of stage suite share.
#pragma once

#include "golden/io/test_support.hpp"
#include "golden/vectors/stage_suite.hpp"

namespace {

using namespace quadrille;
using namespace quadrille::vectors;
namespace fs = std::filesystem;

inline const StageSuite& stage_suite(const std::string& name) {
  return dynamic_cast<const StageSuite&>(find_suite(name));
}

inline Config small_config() {
  Config c;
  c.set("significand_bits", 11);
  c.set("viewport_bits", 8);
  c.set("homogeneous_frac_bits", 5);
  c.set("subpixel_bits", 4);
  c.set("quadratic_frac_bits", 12);
  c.set("attribute_slots", 3);
  c.set("tile_log2", 2);
  c.validate();
  return c;
}

/// A record with its layout: fields by name, and numbers as long double (exponents up to ±1300 fit).
class Values {
 public:
  Values(const Record& record, const RecordLayout& layout) : record_(record), layout_(layout) {}
  std::int64_t integer(const std::string& name, int index = -1) const {
    const RecordField& f = layout_.field(name, index);
    return f.is_signed ? record_.get_signed(f) : static_cast<std::int64_t>(record_.get(f));
  }
  /// sig · 2^(exp - (S-1)), with the sign of PREFIX_neg when there is one.
  long double number(const std::string& prefix, int index = -1, bool has_sign = false) const {
    const RecordField& f = layout_.field(prefix + "sig", index);
    const long double magnitude = ldexpl(static_cast<long double>(record_.get(f)),
                                         static_cast<int>(integer(prefix + "exp", index)) - (f.width - 1));
    return has_sign && integer(prefix + "neg", index) != 0 ? -magnitude : magnitude;
  }

 private:
  const Record& record_;
  const RecordLayout& layout_;
};

/// Calls check(stimulus, response) for every vector of a suite of about `limit`.
template <class Check>
void for_each(const std::string& name, const Config& config, std::uint64_t limit, const Check& check) {
  const auto stage = stage_suite(name).stage(config);
  GenerateOptions options;
  options.config = config;
  options.limit = limit;
  const StageSuite::Stimuli stimuli = stage_suite(name).stimuli(options);
  for (const auto* list : {&stimuli.corner, &stimuli.random, &stimuli.realistic}) {
    ASSERT_FALSE(list->empty());
    for (const Record& stimulus : *list) {
      const Record response = stage->respond(stimulus);
      check(Values(stimulus, stage->stimulus_layout()), Values(response, stage->response_layout()));
      if (testing::Test::HasFailure()) {
        ADD_FAILURE() << name << ": stimulus " << stimulus.to_hex() << " response " << response.to_hex();
        return;
      }
    }
  }
}

}  // namespace
