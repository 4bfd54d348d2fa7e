// What the tests of c api share.
#pragma once

#include "model/c_api/quadrille.h"
#include "model/clocked.hpp"
#include "model/port/boundaries.hpp"
#include "model/port/draw_state.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace quadrille {
namespace {

constexpr int side = 64;

inline ::testing::AssertionResult same(const quadrille_fragment& c, const Fragment& f) {
  Fragment copy;
  copy.quad = c.quad;
  copy.x = c.x;
  copy.y = c.y;
  copy.front = c.front != 0;
  copy.flags = c.flags;
  copy.depth = c.depth;
  std::copy(std::begin(c.attribute), std::end(c.attribute), copy.attribute.begin());
  if (copy == f && c.reserved == 0) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "quad " << c.quad << " (" << c.x << ", " << c.y << "), expected quad "
                                       << f.quad << " (" << f.x << ", " << f.y << ")";
}

inline std::string error() { return quadrille_last_error(); }

}  // namespace
}  // namespace quadrille
