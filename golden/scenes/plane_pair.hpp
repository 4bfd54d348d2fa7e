// Two parallel planes close together, the nearer one over the other: what a depth buffer has to tell apart.
#pragma once

#include "golden/scenes/scenes.hpp"

#include <array>
#include <string_view>
#include <vector>

namespace quadrille::golden {

/// How the camera, at distance 50, sees the planes.
enum class PlaneView {
  facing,  ///< straight on: each has one depth
  turned,  ///< from the side and from above, by 20 degrees
  floor,   ///< as floors, from a height of 5 and along them, from 10 before the eye to 90
};
inline constexpr std::array<PlaneView, 3> plane_views{PlaneView::facing, PlaneView::turned, PlaneView::floor};
std::string_view plane_view_name(PlaneView view);

struct PlanePair {
  PlaneView view = PlaneView::facing;
  double apart = 1;
  bool reversed = false;  ///< window z 1 at the near plane, 0 at the far one
};

/// The distances that the planes are measured at.
inline constexpr std::array<double, 8> plane_distances{1, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005};

/// Quad 0 of the nearer plane, quad 1 of the other, without attributes. Near plane 0.1, far plane 100.
std::vector<WindowQuad> plane_pair(const PlanePair& pair, int width, int height);

/// Eight strips of planes seen as `turned`, in each the nearer plane over the other at one of plane_distances, from
/// left to right. The nearer one is white, and nothing of the other, which is red, shows beside it.
Scene plane_strips();

}  // namespace quadrille::golden
