#include "surface/halftone/halftone.h"

const char *const halftone_coordinate_names[] = {"axes",   "triplanar", "screen", "uv", "curvature",
                                                 "lapped", "form-mesh", "form",   NULL};
const char *const halftone_ink_names[] = {"one", "two", "cmyk", NULL};

mesh_needs halftone_needs(const void *values)
{
    const halftone_values *v = values;
    bool                   lapped = v->coordinates == COORDINATES_LAPPED;
    return (mesh_needs){.field = lapped || v->coordinates == COORDINATES_CURVATURE ||
                                 v->coordinates == COORDINATES_FORM_MESH,
                        .patch = lapped ? v->patch : 0,
                        .rest = true};
}
