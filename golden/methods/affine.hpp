// Bloomenthal's test for affinity between a quad's geometry and its attributes.
#pragma once

#include "golden/methods/method.hpp"

namespace quadrille::golden::methods {

/// Whether the attributes are an affine image of the corners, as one plane equation an attribute draws them
/// (Bloomenthal section 4, listing 3): at every corner the barycentric coordinates with respect to the other three
/// agree between geometry and attributes. Where it differs from the listing:
///  - Areas are signed along the quad's own normal (of the largest triangle of three corners), not by the sign of z,
///    which says nothing for a quad parallel to z.
///  - A corner off the plane of the others by more than `tolerance` of the quad's size is not affine: a plane equation
///    has no fourth height, and areas do not see it.
///  - An area counts as zero relative to the quad's size: FLT_EPSILON times its square.
///  - Barycentric coordinates of attributes exist in two dimensions, and those are compared as in the listing. For any
///    other number of attributes the corner's must be what the geometry's coordinates make of the other three's, within
///    `tolerance` of the largest distance between two corners' attributes; without attributes only the geometry counts.
///  - A triangle (two neighbouring corners equal in window and object space and in their attributes) is affine.
///  - Without View::perspective attributes are linear on the screen, so geometry means x/w and y/w; not affine where a
///    w <= 0.
bool is_affine(const Quad& quad, const View& view, double tolerance);

}  // namespace quadrille::golden::methods
