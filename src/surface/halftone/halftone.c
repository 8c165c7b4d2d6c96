#include "surface/halftone/halftone.h"

const char *const halftone_coordinate_names[] = {"axes", "triplanar", "screen", "uv", "curvature", "lapped", NULL};
const char *const halftone_ink_names[] = {"one", "two", "cmyk", NULL};
