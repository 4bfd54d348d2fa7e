// One builder a method; outside this folder and its tests use make_method().
#pragma once

#include "golden/methods/method.hpp"

namespace quadrille::golden::methods {

enum class Diagonal { v0_v2, v1_v3 };

/// Which published form of the fragment program `hybrid` follows.
enum class HybridForm {
  pixels,       ///< both kill and guard, in pixels
  ndc,          ///< both kill and guard, in normalised device coordinates
  tarini,       ///< Hormann & Tarini section 5.1: pixels, mixed signs are killed, no guard
  bloomenthal,  ///< Bloomenthal listing 2: NDC, |A| < 1e-6 gives t = 0, nothing is killed
};

std::unique_ptr<Method> make_mvc();
std::unique_ptr<Method> make_split(Diagonal diagonal);
std::unique_ptr<Method> make_triangle(int fraction_bits);  ///< 4 … 20
std::unique_ptr<Method> make_twofold();
std::unique_ptr<Method> make_projective();
std::unique_ptr<Method> make_bilinear();
std::unique_ptr<Method> make_refine(int n);               ///< 1 … 1000
std::unique_ptr<Method> make_adaptive(double threshold);  ///< of object space, 1e-6 … 1; texture space: a tenth of it
std::unique_ptr<Method> make_hybrid(HybridForm form);
std::unique_ptr<Method> make_affine(double tolerance);  ///< 0 … 1

}  // namespace quadrille::golden::methods
