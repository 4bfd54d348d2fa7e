#include "golden/explain/numbers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

namespace quadrille::explain {
namespace {

std::int64_t integer(const Field& field) { return static_cast<std::int64_t>(field.value); }

/// Sign, exponent and significand; sign may be missing.
struct Parts {
  const Field *neg = nullptr, *exp = nullptr, *sig = nullptr;

  explicit Parts(const Number& number) : exp(&number.stored[number.stored.size() - 2]), sig(&number.stored.back()) {
    if (number.stored.size() == 3) neg = &number.stored.front();
  }
};

/// Of the last place of a stored number; of a stored 0 the exact one's.
Float113 last_place(const Number& number, Float113 exact) {
  if (number.format == Number::Format::integer) return 1;
  if (number.format == Number::Format::fixed) return scaled(1, -number.fraction_bits);
  const Parts parts(number);
  if (parts.sig->value != 0) return scaled(1, static_cast<int>(integer(*parts.exp)) - number.fraction_bits);
  return exact == 0 ? Float113{1} : scaled(1, exponent_of(exact) - number.fraction_bits);
}

}  // namespace

std::string Field::label() const { return index < 0 ? name : name + "[" + std::to_string(index) + "]"; }

std::string Field::text() const { return is_signed ? std::to_string(integer(*this)) : std::to_string(value); }

void FieldCollector::add(const FieldType& type, Field field) {
  const std::string_view name(type.name);
  Listed listed{std::move(field), std::string(name), "", type.meaning, type.unit, {}};
  if (type.fraction_bits) listed.fraction_bits = *type.fraction_bits;
  for (const std::string_view part : {"neg", "exp", "sig"}) {
    if (!name.ends_with(part) || (name.size() > part.size() && name[name.size() - part.size() - 1] != '_')) continue;
    listed.part = part;
    listed.stem = name.substr(0, name.size() - std::min(name.size(), part.size() + 1));
  }
  listed_.push_back(std::move(listed));
}

std::vector<Draft> FieldCollector::drafts() const {
  std::vector<std::string> order;
  for (const Listed& one : listed_)
    if (std::ranges::find(order, one.stem) == order.end()) order.push_back(one.stem);
  std::vector<Draft> drafts;
  for (const std::string& stem : order) {
    const std::size_t first = drafts.size();
    for (const Listed& one : listed_) {
      if (one.stem != stem) continue;
      const auto same = std::find_if(drafts.begin() + static_cast<std::ptrdiff_t>(first), drafts.end(),
                                     [&](const Draft& d) { return d.index == one.field.index; });
      Draft& draft = same != drafts.end() ? *same : drafts.emplace_back(Draft{stem, one.field.index, {}});
      Number& number = draft.number;
      number.stored.push_back(one.field);
      if (one.part.empty()) {
        number.format = one.fraction_bits ? Number::Format::fixed : Number::Format::integer;
      } else {
        number.format = Number::Format::significand;
      }
      if (one.part.empty() || one.part == "sig") {
        number.meaning = one.meaning;
        number.unit = one.part.empty() ? one.unit : "";
        number.fraction_bits = one.part.empty() ? one.fraction_bits.value_or(0) : one.field.width - 1;
      }
    }
    std::stable_sort(drafts.begin() + static_cast<std::ptrdiff_t>(first), drafts.end(),
                     [](const Draft& a, const Draft& b) { return a.index < b.index; });
  }
  for (Draft& draft : drafts) set_unit(draft.number, 1, draft.number.unit == "1" ? "" : draft.number.unit.c_str());
  return drafts;
}

Number significand_number(const PipelineFloat& v, int significand_bits) {
  Number number;
  number.format = Number::Format::significand;
  number.fraction_bits = significand_bits - 1;
  number.stored = {{"neg", -1, 1, false, v.neg},
                   {"exp", -1, Config::exp_bits, true, field_bits(v.exp)},
                   {"sig", -1, significand_bits, false, v.sig}};
  number.value = static_cast<double>(stored_value(number));
  return number;
}

Float113 stored_value(const Number& number) {
  if (number.format != Number::Format::significand) {
    const Field& field = number.stored.front();
    const Float113 value = field.is_signed ? Float113(integer(field)) : Float113(field.value);
    return scaled(value, -number.fraction_bits);
  }
  const Parts parts(number);
  const Float113 size =
      scaled(Float113(parts.sig->value), static_cast<int>(integer(*parts.exp)) - number.fraction_bits);
  return parts.neg != nullptr && parts.neg->value != 0 ? -size : size;
}

void set_unit(Number& number, double scale, const char* unit) {
  number.unit = std::string_view(unit) == "px^2" ? "px²" : unit;
  number.value = static_cast<double>(stored_value(number) * scale);
}

void set_exact(Number& number, const Beside& beside) {
  set_unit(number, beside.scale, beside.unit);
  number.exact = static_cast<double>(beside.exact * beside.scale);
  number.exact_digits = decimal(beside.exact * beside.scale, 30);
  const Float113 place = beside.place ? Float113(*beside.place) : last_place(number, beside.exact);
  number.error_ulp = static_cast<double>((stored_value(number) - beside.exact) / place);
  if (beside.ulps) number.bound_ulp = *beside.ulps;
  if (beside.absolute) number.bound_ulp = static_cast<double>(Float113(*beside.absolute) / place);
  if (!number.bound_ulp) return;
  if (!std::isfinite(*number.bound_ulp)) {
    number.bound_ulp.reset();
    return;
  }
  const double size = std::fabs(number.error_ulp);
  number.of_bound = size == 0                ? 0
                    : *number.bound_ulp == 0 ? std::numeric_limits<double>::infinity()
                                             : size / *number.bound_ulp;
}

const char* pair_name(std::size_t pair) {
  constexpr std::array<const char*, linear_count> names{"01", "12", "23", "30", "20", "13"};
  return names[pair];
}

}  // namespace quadrille::explain
