// One step of a climb that moves vertices: anywhere, by a subpixel, in w, toward the pixel or with it.
#pragma once

#include "golden/reference/truth.hpp"
#include "model/port/records.hpp"
#include "model/support/prng.hpp"
#include "tb/judge/pixel_error.hpp"

namespace quadrille::tb {

/// Changes one to three things of the quad, which has one attribute in [-1, 1], or its pixel. Attributes are changed
/// for that output alone.
void move_vertices(WindowQuad& quad, golden::PixelPlace& at, Output output, int width, int height, golden::Prng& rng);

}  // namespace quadrille::tb
