#include "tb/studies/compare/frame_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace quadrille::compare {
namespace {

/// Both defined, so a number; infinite when the difference of two finite numbers is.
double pixel_error(const AttributeImage& a, const AttributeImage& b, std::size_t pixel) {
  double largest = 0;
  for (std::size_t c = 0; c < static_cast<std::size_t>(a.channels); ++c)
    largest = std::max(largest, std::fabs(a.values(pixel)[c] - b.values(pixel)[c]));
  return largest;
}

}  // namespace

FrameError compare_frames(const AttributeImage& method, const AttributeImage& reference, double wrong_above) {
  if (method.width != reference.width || method.height != reference.height || method.channels != reference.channels)
    throw std::invalid_argument("frames of different sizes or channels cannot be compared");
  FrameError result;
  double squares = 0;
  result.image.reserve(method.quad.size());
  for (int y = 0; y < method.height; ++y) {
    for (int x = 0; x < method.width; ++x) {
      const std::size_t p = method.pixel(x, y);
      const bool in_method = method.covered(p), in_reference = reference.covered(p);
      if (!in_method && !in_reference) {
        result.image.push_back(FrameError::neither_draws);
        continue;
      }
      const bool method_number = method.defined(p), reference_number = reference.defined(p);
      const bool both = in_method && in_reference, same_quad = method.quad[p] == reference.quad[p];
      result.method_covered += in_method;
      result.reference_covered += in_reference;
      result.missing += !in_method;
      result.extra += !in_reference;
      result.other_quad += both && !same_quad;
      result.method_undefined += in_method && !method_number;
      result.reference_undefined += in_reference && !reference_number;
      if (!same_quad || !method_number || !reference_number) {
        result.image.push_back(std::numeric_limits<float>::quiet_NaN());
        continue;
      }
      const double error = pixel_error(method, reference, p);
      if (result.error.count() == 0 || error > result.error.max()) result.x = x, result.y = y;
      result.error.add(error);
      squares += error * error;
      result.wrong += !(error <= wrong_above);
      result.image.push_back(static_cast<float>(error));
    }
  }
  if (result.error.count() > 0) result.rms = std::sqrt(squares / static_cast<double>(result.error.count()));
  return result;
}

}  // namespace quadrille::compare
