// Names and knobs of the methods.
#include "golden/methods/builders.hpp"
#include "model/support/edit_distance.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace quadrille::golden::methods {
namespace {

constexpr std::array<MethodInfo, 11> methods{{
    {"mvc", "", "Hormann & Tarini 2004, sections 3 and 4", "mean value coordinates of the whole quad"},
    {"split02", "", "diagonal split", "triangles 012 and 023"},
    {"split13", "", "diagonal split", "triangles 123 and 130"},
    {"triangle", "fraction bits = 12", "MIT 6.837 (2000), lecture 6",
     "split02 by integer edge equations and plane equations, without perspective correction"},
    {"twofold", "", "Hormann & Tarini 2004, section 1", "linear along the edges, then along each scan line"},
    {"projective", "", "Hormann & Tarini 2004, section 1", "projective map to the unit square, bilinear there"},
    {"bilinear", "", "Quilez 2010, as cited by Bloomenthal 2022, section 3.3", "inverse bilinear interpolation"},
    {"refine", "N = 20", "Hormann & Tarini 2004, section 1",
     "N × N bilinear refinement in space, split along diagonals"},
    {"adaptive", "threshold = 1e-3", "Oliveira, figures 10 and 11", "adaptive subdivision towards parallelograms"},
    {"hybrid", "form = pixels (or ndc, tarini, bloomenthal)",
     "Hormann & Tarini 2004, section 5.1; Bloomenthal 2022, listing 2",
     "two triangles whose fragments compute mean value coordinates in single precision"},
    {"affine", "tolerance = 0.01", "Bloomenthal 2022, listing 3",
     "a plane equation where the attributes are an affine image of the corners, mvc elsewhere"},
}};

/// " (mvc, split02, ...)"
std::string all_names() {
  std::string text = " (";
  for (const MethodInfo& info : methods) text.append(&info == methods.data() ? "" : ", ").append(info.name);
  return text + ")";
}

[[noreturn]] void unknown(std::string_view name) {
  throw std::invalid_argument("unknown method '" + std::string(name) + "'" +
                              did_you_mean(name, methods, &MethodInfo::name) + all_names());
}

[[noreturn]] void bad_spec(std::string_view spec, const std::string& wanted) {
  throw std::invalid_argument("method '" + std::string(spec) + "': " + wanted);
}

/// The number after the colon, `standard` where there is none; refused outside [low, high].
template <class Number>
Number knob(std::string_view spec, std::string_view text, Number standard, Number low, Number high,
            const std::string& wanted) {
  if (text.empty()) return standard;
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= low && value <= high))
    bad_spec(spec, wanted);
  return value;
}

}  // namespace

std::span<const MethodInfo> list_methods() { return methods; }

std::unique_ptr<Method> make_method(std::string_view spec) {
  const std::size_t colon = spec.find(':');
  const std::string_view name = spec.substr(0, colon);
  const std::string_view text = colon == std::string_view::npos ? std::string_view() : spec.substr(colon + 1);
  if (name.empty()) bad_spec(spec, "the name is missing" + all_names());
  const auto info = std::ranges::find(methods, name, &MethodInfo::name);
  if (info == methods.end()) unknown(name);
  if (colon != std::string_view::npos && text.empty()) bad_spec(spec, "nothing follows the colon");
  if (info->knob.empty() && !text.empty()) bad_spec(spec, std::string(name) + " has no knob");

  if (name == "mvc") return make_mvc();
  if (name == "split02") return make_split(Diagonal::v0_v2);
  if (name == "split13") return make_split(Diagonal::v1_v3);
  if (name == "triangle") return make_triangle(knob(spec, text, 12, 4, 20, "fraction bits are a number from 4 to 20"));
  if (name == "twofold") return make_twofold();
  if (name == "projective") return make_projective();
  if (name == "bilinear") return make_bilinear();
  if (name == "refine") return make_refine(knob(spec, text, 20, 1, 1000, "N is a number from 1 to 1000"));
  if (name == "adaptive")
    return make_adaptive(knob(spec, text, 1e-3, 1e-6, 1.0, "the threshold is a number from 1e-6 to 1"));
  if (name == "affine") return make_affine(knob(spec, text, 0.01, 0.0, 1.0, "the tolerance is a number from 0 to 1"));
  if (text.empty() || text == "pixels") return make_hybrid(HybridForm::pixels);
  if (text == "ndc") return make_hybrid(HybridForm::ndc);
  if (text == "tarini") return make_hybrid(HybridForm::tarini);
  if (text == "bloomenthal") return make_hybrid(HybridForm::bloomenthal);
  bad_spec(spec, "the form is pixels, ndc, tarini or bloomenthal");
}

}  // namespace quadrille::golden::methods
