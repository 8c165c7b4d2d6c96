/* Inside the api folder: arguments of calls that change what a scene has. Errors are LMN_USAGE. */
#ifndef LIMNER_API_CHECK_CONTENT_H
#define LIMNER_API_CHECK_CONTENT_H

#include "scene/scene.h"

lmn_status content_check_scene(const lmn_scene *scene, const char *caller, lmn_error *error);
lmn_status content_check_range(double value, double least, double most, const char *what, const char *caller,
                               lmn_error *error);
/* 0 … count. */
lmn_status content_check_number(uint32_t number, size_t count, const char *what, const char *caller, lmn_error *error);
/* A node that is there. */
lmn_status content_check_node(const lmn_scene *scene, uint32_t number, const char *caller, lmn_error *error);
/* NONE for 0. */
int32_t content_index(uint32_t number);
/* True with *out NULL where there is none to copy. */
bool content_copy_name(char **out, const char *name);

#endif
