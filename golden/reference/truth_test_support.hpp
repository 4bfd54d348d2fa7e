// What the tests of truth share.
#pragma once

#include "golden/reference/float113_test_support.hpp"
#include "golden/reference/test_quads.hpp"
#include "golden/reference/truth.hpp"

#include <cmath>

namespace quadrille::golden {
namespace {

using test::make_quad;
using test::one;
using test::Point;
using test::port;
using test::Random;

inline const Config config;
const DrawState draw;
constexpr double double_ulp = 0x1p-52;  // of 1: every double result is a rounded value of magnitude about 1

inline TruthQuad truth_of(const SnappedQuad& quad) { return {quad, config, draw}; }

inline double port_double(const PortNumber& p) {
  return (p.neg ? -1.0 : 1.0) * p.sig * std::exp2(p.exp - (config.significand_bits - 1));
}

}  // namespace
}  // namespace quadrille::golden
