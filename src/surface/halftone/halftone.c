#include "surface/halftone/halftone.h"

#include "halftone/random.h"

const char *const halftone_coordinate_names[] = {"axes", "triplanar", "screen", "uv", "curvature", "lapped", NULL};
const char *const halftone_ink_names[] = {"one", "two", "cmyk", NULL};

mesh_wishes halftone_wishes(const void *values)
{
    const halftone_values *v = values;
    bool lapped = v->coordinates == COORDINATES_LAPPED;
    return (mesh_wishes){.field = lapped || v->coordinates == COORDINATES_CURVATURE, .patch = lapped ? v->patch : 0};
}

void halftone_describe_noise(text *out, const void *values)
{
    (void)values;
    text_append(out, "1");
}

lmn_status halftone_make_noise(mip_chain *out, const void *values, lmn_error *error)
{
    enum { SIDE = 128, SEED = 20031119 };
    (void)values;
    lmn_status status = mip_chain_create(out, SIDE, SIDE, 1, 1, MIP_RG8, error);
    if (status != LMN_OK)
        return status;
    random_source chance = random_start(SEED, 0);
    for (size_t i = 0; i < mip_level_bytes(out, 0); i++)
        ((uint8_t *)out->data[0])[i] = (uint8_t)(random_bits(&chance) >> 56);
    return LMN_OK;
}
