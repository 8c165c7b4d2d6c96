/* Which moments of an animation tell most of it: turning points, extremes, contacts, poses whose sides differ most.
 * Needs no GPU. Großmann 2011, sections 2.2.2 and 2.3; row 77j. */
#ifndef LIMNER_TRACE_TELLING_H
#define LIMNER_TRACE_TELLING_H

#include <jansson.h>

#include "base/warnings.h"
#include "pose/pose.h"
#include "stroke/stroke.h"

enum { TELLING_MOST = 64 };

/* Why a moment was taken. */
typedef enum telling_reason {
    TELLING_CONTACT, /* something stops or rebounds at once, as what hits the ground */
    TELLING_TURN,    /* something turns back on its way, or limbs are farthest apart */
    TELLING_END,     /* the animation begins or ends */
    TELLING_BETWEEN  /* nothing is told; it fills a gap */
} telling_reason;

typedef struct telling_moment {
    double         ago; /* seconds before the pose */
    telling_reason reason;
    double asymmetry; /* of skeletons: how far the left side is from the mirrored right one, fraction of its size */
} telling_moment;

typedef struct telling_moments {
    telling_moment at[TELLING_MOST]; /* newest first */
    double         now;              /* seconds */
    size_t         count, wanted;    /* wanted 0: as many as tell something */
} telling_moments;

typedef struct telling_options {
    const pose   *pose;  /* the last moment that counts */
    const bool   *parts; /* per part: what matters */
    double        seconds;
    stroke_camera camera;
    int           count;      /* 0: as many as tell something */
    double        cover;      /* how much of one figure may lie over another one, fraction of the smaller one */
    bool          beside_now; /* the pose itself is drawn, too, and none may cover it */
} telling_options;

/* Looks at the parts' ways on the page, and takes the moments at which most of them turn, stop or rebound, best first,
 * but for those whose figures would cover each other more than `cover`. Where fewer tell something than are wished for,
 * others fill the largest gaps, as far as there is room. Errors: LMN_MEMORY, LMN_FORMAT, LMN_CANCELLED. */
lmn_status telling_find(telling_moments *out, const telling_options *options, lmn_error *error);

/* For reports: [{"time", "reason", "asymmetry"}]. */
json_t *telling_json(const telling_moments *m);
/* Says when fewer are drawn than were wished for. */
void telling_warn(const telling_moments *m, warnings *warnings);

#endif
