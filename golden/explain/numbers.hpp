// From the fields of a boundary's record to numbers with names. Not for use outside this folder.
#pragma once

#include "golden/explain/exact_pixel.hpp"
#include "golden/explain/explain.hpp"
#include "model/port/fields.hpp"

#include <optional>
#include <string>
#include <vector>

namespace quadrille::explain {

/// A number that has no name yet: `stem` is what the names of its fields begin with, "a" of a_neg, a_exp and a_sig.
struct Draft {
  std::string stem;
  int index = -1;
  Number number;
};

/// Collects what a list of fields holds (model/port/fields.hpp).
class FieldCollector {
 public:
  template <class T>
  void operator()(const FieldType& type, int index, const T& value) {
    add(type, {type.name, index, type.width, type.is_signed, field_bits(value)});
  }
  /// In the list's order of names, arrays from element 0 up.
  std::vector<Draft> drafts() const;

 private:
  struct Listed {
    Field field;
    std::string stem, part, meaning, unit;
    std::optional<int> fraction_bits;
  };
  void add(const FieldType& type, Field field);

  std::vector<Listed> listed_;
};

/// What list(f) lists.
template <class List>
std::vector<Draft> drafts_of(List&& list) {
  FieldCollector collector;
  list(collector);
  return collector.drafts();
}

/// A number without a record, a quotient's reciprocal say.
Number significand_number(const PipelineFloat& v, int significand_bits);

/// What the stored integers stand for, without `unit`'s scale.
Float113 stored_value(const Number& number);

/// Exact arithmetic beside a stored number.
struct Beside {
  Float113 exact = 0;  ///< as stored_value() counts
  double scale = 1;    ///< `unit`s of what stored_value() counts in
  const char* unit = "";
  /// How far the error may go; `ulps` counts in last places, `absolute` as `exact` does.
  std::optional<double> ulps{}, absolute{};
  std::optional<double> place{};  ///< of the last place, where it is not that of the format
};
void set_exact(Number& number, const Beside& beside);
/// Only the scale and unit, of a number with nothing beside.
void set_unit(Number& number, double scale, const char* unit);

/// "01" of pair 0.
const char* pair_name(std::size_t pair);

}  // namespace quadrille::explain
