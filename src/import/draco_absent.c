/* Stands in for draco.cpp in builds without Draco. */
#include "import/draco.h"

#ifndef LIMNER_HAVE_DRACO

bool draco_is_built(void)
{
    return false;
}

draco_model *draco_open(const unsigned char *bytes, size_t size)
{
    (void)bytes;
    (void)size;
    return NULL;
}

void draco_close(draco_model *model)
{
    (void)model;
}

size_t draco_vertex_count(const draco_model *model)
{
    (void)model;
    return 0;
}

size_t draco_triangle_count(const draco_model *model)
{
    (void)model;
    return 0;
}

void draco_read_indices(const draco_model *model, uint32_t *out)
{
    (void)model;
    (void)out;
}

bool draco_read_attribute(const draco_model *model, uint32_t id, int components, bool normalized, float *out)
{
    (void)model;
    (void)id;
    (void)components;
    (void)normalized;
    (void)out;
    return false;
}

#endif
