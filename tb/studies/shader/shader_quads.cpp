#include "golden/reference/port_number.hpp"
#include "tb/studies/shader/quad_shader.hpp"

#include <cmath>

namespace quadrille::tb {
namespace {

void fill(std::vector<float>& numbers, std::size_t begin, int attributes) {
  numbers.resize(begin + static_cast<std::size_t>(4 * vertex_vectors(attributes)), 0.0F);
}

}  // namespace

void ShaderQuads::add(const SnappedQuad& quad, const Config& config, bool perspective) {
  const auto coordinate = [&](std::int32_t value) {
    numbers_.push_back(static_cast<float>(std::ldexp(static_cast<double>(value), -config.frac())));
  };
  const auto port = [&](const PortNumber& number) {
    numbers_.push_back(static_cast<float>(golden::port_value(number, config.significand_bits)));
  };
  const auto with_base = [&](const PortNumber& difference, double base, double scale) {
    numbers_.push_back(static_cast<float>(golden::port_value(difference, config.significand_bits) + base * scale));
  };
  for (std::size_t i = 0; i < 4; ++i) {
    const SnappedVertex& vertex = quad.vertex[i];
    const std::size_t begin = numbers_.size();
    const double w = std::ldexp(static_cast<double>(vertex.w), -config.frac());
    const double k = perspective ? golden::port_value(vertex.k, config.significand_bits) : w;
    coordinate(vertex.x);
    coordinate(vertex.y);
    coordinate(vertex.w);
    port(vertex.k);
    with_base(vertex.z, std::ldexp(static_cast<double>(quad.base.depth), -config.depth_bits), w);
    for (std::size_t a = 0; a < static_cast<std::size_t>(attributes_); ++a)
      with_base(i == 0 ? PortNumber{} : vertex.attribute[a],
                std::ldexp(static_cast<double>(quad.base.attribute[a]), -config.attribute_frac()), k);
    fill(numbers_, begin, attributes_);
  }
}

void ShaderQuads::add(const WindowQuad& quad) {
  const auto number = [&](double value) { numbers_.push_back(static_cast<float>(value)); };
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t begin = numbers_.size();
    const WindowVertex& vertex = quad.vertex[i];
    number(vertex.x);
    number(vertex.y);
    number(vertex.w);
    number(1);
    number(vertex.z);
    const std::vector<double>& given = quad.attribute[i];
    for (std::size_t a = 0; a < static_cast<std::size_t>(attributes_); ++a) number(a < given.size() ? given[a] : 0.0);
    fill(numbers_, begin, attributes_);
  }
}

std::size_t ShaderQuads::size() const {
  return numbers_.size() / static_cast<std::size_t>(16 * vertex_vectors(attributes_));
}

}  // namespace quadrille::tb
