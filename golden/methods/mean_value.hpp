// Mean value coordinates of a quad at one point of the screen, in homogeneous form.
#pragma once

#include "model/port/records.hpp"

#include <array>

namespace quadrille::golden::methods {

/// M_0..M_3 at window position (x, y) up to a common factor of either sign: eq. (8) of Hormann & Tarini (2004) with
/// S_i = (x~ - w x, y~ - w y), R_i = |S_i|, A_i = S_i x S_{i+1}, D_i = S_i . S_{i+1}:
///   t_i = (R_i R_{i+1} - D_i) / A_i where D_i < 0, A_i / (R_i R_{i+1} + D_i) elsewhere;  M_i = (t_{i-1} + t_i) / R_i
/// multiplied out so that nothing is divided by A_i. Any sign of w: t is that of the paper, and M_i = mu_i / w_i, so
/// M_i / sum(M) is eq. (10) and M_i w_i / sum(M w) eq. (7).
///
/// Singular points, the first that applies: two corners at the point: each counts for half; one corner: that corner
/// alone; on two edges at once: the mean of the two edge interpolations; on one edge: linear along it, which the
/// general form gives by itself. `share` is what a corner's M is multiplied with to get the weight that is wanted (1
/// with perspective, w without): halves and means are of weights.
///
/// Relative error about 2^-52 max(|x~|, |y~|, |w x|, |w y|) / R_i, times the cancellation of t_{i-1} + t_i at reflex
/// corners.
std::array<double, 4> mean_value_weights(const std::array<WindowVertex, 4>& vertex, const std::array<double, 4>& share,
                                         double x, double y);

/// The point that weights M show, sum(M V) / sum(M), is in front of the eye: w > 0, and not merely by rounding. Below
/// 2^-40 of sum(|M w|) the sum counts as 0; it is 0 where the eye and all corners are in one plane.
bool in_front(const std::array<double, 4>& m, const std::array<WindowVertex, 4>& vertex);

}  // namespace quadrille::golden::methods
