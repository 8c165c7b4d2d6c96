/* What reports of pictures and of sheets have in common, as JSON. */
#ifndef LIMNER_PLAN_REPORT_JSON_H
#define LIMNER_PLAN_REPORT_JSON_H

#include <jansson.h>

#include "base/warnings.h"
#include "plan/camera.h"
#include "stroke/stroke.h"

json_t *report_box_json(box3 b);
json_t *report_camera_json(const view_camera *c);
json_t *report_warnings_json(const warnings *list);
/* How many strokes of each class; classes without any are left out. */
/* `outline_search` of the report, where meshes were refined. */
void    report_search(json_t *root, outline_search search);
json_t *report_strokes_json(const uint64_t counts[STROKE_CLASS_COUNT]);
/* The text of a report, whose reference it takes over; NULL when memory is gone. */
char *report_dump(json_t *root);

#endif
