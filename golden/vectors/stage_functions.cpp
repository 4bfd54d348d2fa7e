// Square root and reciprocal.
#include "golden/vectors/stage_numbers.hpp"
#include "golden/vectors/stage_of.hpp"
#include "golden/vectors/stage_suites.hpp"

namespace quadrille::vectors {
namespace {

// ---- sqrt ----

struct SqrtLists {
  template <class D, class F>
  static void stimulus(D& d, const Config& c, F&& f) {
    visit_numbers(
        f, magnitudes("exp", "sig", c, "r2 in units of 2^-QUADRATIC_FRAC px^2"),
        4, [&](std::size_t i) -> auto& { return d.pixel.r2_fp[i]; });
  }
  template <class D, class F>
  static void response(D& d, const Config& c, F&& f) {
    visit(d.pixel, Boundary::sqrt, c, f);
  }
};

class Sqrt : public StageOf<SqrtLists> {
 public:
  explicit Sqrt(const Config& config) : StageOf(config) {}
  void run(StageData& d) const override { sqrt_stage(d.pixel, context_); }

  FieldRange range(const RecordField& f) const override {
    return f.name == "exp" ? FieldRange{0, Exponents(config()).d_hi} : StageUnderTest::range(f);
  }
  void constrain(StageData& d) const override {
    for (PipelineFloat& v : d.pixel.r2_fp) clear_zero(v);
  }

  void corners(const Sink& sink) const override {
    // Both sides of every segment boundary in both octaves.
    const std::uint32_t lowest = std::uint32_t{1} << (config().significand_bits - 1);
    const std::uint32_t step = std::uint32_t{1} << context_.sqrt_table.rest_bits;
    for (std::uint32_t sig = lowest; sig < 2 * lowest; sig += step)
      for (const int exp : {20, 21}) {
        StageData d;
        d.pixel.r2_fp = {
            {{false, exp, sig}, {false, exp, sig + 1}, {false, exp, sig + step - 1}, {false, exp, sig + step / 2}}};
        sink(d);
      }
  }
};

// ---- reciprocal ----

struct ReciprocalLists {
  template <class D, class F>
  static void stimulus(D& d, const Config& c, F&& f) {
    visit_number(f, signed_numbers("neg", "exp", "sig", c, "the number"), d.number);
  }
  template <class D, class F>
  static void response(D& d, const Config& c, F&& f) {
    visit_number(f, signed_numbers("neg", "exp", "sig", c, "its reciprocal; of 0: 0"), d.inverse);
  }
};

class Reciprocal : public StageOf<ReciprocalLists> {
 public:
  explicit Reciprocal(const Config& config) : StageOf(config) {}
  void run(StageData& d) const override { d.inverse = reciprocal(d.number, context_.recip_table, context_.format); }

  FieldRange range(const RecordField& f) const override {
    const Exponents e(config());
    return f.name == "exp" ? FieldRange{e.sum_lo, e.sum_hi} : StageUnderTest::range(f);
  }
  void constrain(StageData& d) const override { clear_zero(d.number); }

  void corners(const Sink& sink) const override {
    const std::uint32_t lowest = std::uint32_t{1} << (config().significand_bits - 1);
    const std::uint32_t step = std::uint32_t{1} << context_.recip_table.rest_bits;
    StageData d;
    for (std::uint32_t sig = lowest; sig < 2 * lowest; sig += step)
      for (const std::uint32_t offset : {std::uint32_t{0}, std::uint32_t{1}, step / 2, step - 1}) {
        d.number = {offset % 2 == 1, static_cast<int>(offset) - 3, sig + offset};
        d.number.exp %= 64;
        sink(d);
      }
  }
};

}  // namespace

Stage make_sqrt(const Config& config) { return std::make_unique<Sqrt>(config); }
Stage make_reciprocal(const Config& config) { return std::make_unique<Reciprocal>(config); }

}  // namespace quadrille::vectors
