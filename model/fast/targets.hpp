// Code for one instruction set after the other in one source: between QUADRILLE_TARGET_… and QUADRILLE_TARGET_END
// functions are compiled for it, lambdas with LANE_LAMBDA too, whatever the rest is compiled for.
#pragma once

#include "model/support/lane_target.hpp"

#ifdef QUADRILLE_LANE_TARGETS
#include <immintrin.h>
#ifdef __clang__
#define QUADRILLE_TARGET_V2 \
  _Pragma("clang attribute push(__attribute__((target(\"arch=x86-64-v2\"))), apply_to = function)")
#define QUADRILLE_TARGET_V3 \
  _Pragma("clang attribute push(__attribute__((target(\"arch=x86-64-v3\"))), apply_to = function)")
#define QUADRILLE_TARGET_V4 \
  _Pragma("clang attribute push(__attribute__((target(\"arch=x86-64-v4\"))), apply_to = function)")
#define QUADRILLE_TARGET_END _Pragma("clang attribute pop")
#else
#define QUADRILLE_TARGET_V2 _Pragma("GCC push_options") _Pragma("GCC target(\"arch=x86-64-v2\")")
#define QUADRILLE_TARGET_V3 _Pragma("GCC push_options") _Pragma("GCC target(\"arch=x86-64-v3\")")
#define QUADRILLE_TARGET_V4 _Pragma("GCC push_options") _Pragma("GCC target(\"arch=x86-64-v4\")")
#define QUADRILLE_TARGET_END _Pragma("GCC pop_options")
#endif
#endif

/// Before a loop over few registers, which stay in memory otherwise; GCC sees that by itself.
#ifdef __clang__
#define LANE_UNROLL _Pragma("clang loop unroll(full)")
#else
#define LANE_UNROLL
#endif

#define LANE_LAMBDA __attribute__((always_inline))
