// The planes are where they are said to be: by window depth, from which distance follows.
#include "golden/scenes/plane_pair.hpp"
#include "golden/scenes/test_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace quadrille::golden {
namespace {

/// Distance from the eye plane of a vertex: w of a perspective camera.
double distance(const WindowVertex& v) { return v.w; }

/// Window z that OpenGL's projection gives at a distance, near plane 0.1 and far plane 100.
double depth_at(double distance) { return 100.0 / 99.9 * (1 - 0.1 / distance); }

TEST(PlanePair, PlanesAreApartAndInFront) {
  for (const PlaneView view : plane_views)
    for (const double apart : plane_distances)
      for (const bool reversed : {false, true}) {
        const auto quads = plane_pair({view, apart, reversed}, 256, 256);
        ASSERT_EQ(quads.size(), 2u);
        for (const WindowQuad& quad : quads)
          for (const WindowVertex& v : quad.vertex) {
            const double z = depth_at(distance(v));
            EXPECT_NEAR(v.z / v.w, reversed ? 1 - z : z, 1e-12) << plane_view_name(view);
            EXPECT_GT(v.z / v.w, 0);
            EXPECT_LT(v.z / v.w, 1);
          }
        for (std::size_t i = 0; i < 4; ++i) {
          const double farther = distance(quads[1].vertex[i]) - distance(quads[0].vertex[i]);
          // How far along the view the farther plane is: all of it, cos 20 degrees, or the view's slope of 1 in 10.
          const double slope = view == PlaneView::facing   ? 1
                               : view == PlaneView::turned ? 50 / std::hypot(15, 10, 50)
                                                           : 5 / std::hypot(5, 50);
          EXPECT_NEAR(farther, slope * apart, 1e-9) << plane_view_name(view);
        }
      }
}

TEST(PlanePair, StripsHaveEachDistanceAndTheNearerPlaneLast) {
  const Scene scene = make_scene("planes");
  const auto quads = scene_quads(scene, 512, 256, AttributeSet::colour);
  ASSERT_EQ(quads.size(), 2 * plane_distances.size());
  for (std::size_t i = 0; i < plane_distances.size(); ++i) {
    const WindowQuad &back = quads[2 * i], &front = quads[2 * i + 1];
    EXPECT_GT(front.attribute[0][2], back.attribute[0][2]);
    // The farther plane lies within the outline of the nearer one, from the same depth on but for its distance.
    for (const WindowVertex& v : back.vertex) {
      EXPECT_TRUE(probe_visible(front, v.x / v.w, v.y / v.w)) << i;
      double there = 0;  // w of the nearer plane at this place: 1/w is linear on the screen
      {
        const WindowVertex &a = front.vertex[0], &b = front.vertex[1], &d = front.vertex[3];
        const double ax = a.x / a.w, ay = a.y / a.w, bx = b.x / b.w - ax, by = b.y / b.w - ay, dx = d.x / d.w - ax,
                     dy = d.y / d.w - ay, x = v.x / v.w - ax, y = v.y / v.w - ay;
        const double s = (x * dy - y * dx) / (bx * dy - by * dx), t = (bx * y - by * x) / (bx * dy - by * dx);
        there = 1 / (1 / a.w + s * (1 / b.w - 1 / a.w) + t * (1 / d.w - 1 / a.w));
      }
      EXPECT_GT(distance(v), there) << i;
      EXPECT_NEAR(distance(v) - there, plane_distances[i], 0.2 * plane_distances[i]) << i;
    }
    if (i == 0) continue;
    const WindowVertex &left = quads[2 * i - 1].vertex[1], &right = front.vertex[0];
    EXPECT_GT(right.x / right.w, left.x / left.w);
  }
}

}  // namespace
}  // namespace quadrille::golden
