// What `bench --peers` draws: quads with texture coordinates, in perspective, the same on every machine up to libm.
#pragma once

#include "model/port/records.hpp"

#include <vector>

namespace quadrille::tb {

inline constexpr int peer_attributes = 2;  ///< u, v

/// One convex quad in perspective that fills nearly all of the viewport.
std::vector<WindowQuad> large_quad(int width, int height);

/// A sphere of `n` quads around and `n` from pole to pole, its back too.
std::vector<WindowQuad> sphere_quads(int n, int width, int height);

}  // namespace quadrille::tb
