/* Limner draws 3D models the way people draw. This header is all of the public API. What follows holds for all of it
 * where nothing else is said.
 *
 * Ownership: what functions called create, load, parse, open, begin and draw give belongs to the caller, who ends it
 * with the function called destroy, close or end of its kind. These may come in any order: drawings and sheets need
 * neither scene nor look nor renderer any more. Texts that are not const are freed with lmn_text_free; const ones are
 * borrowed from the object that was asked, until it changes or ends. What callers hand over is only read, during the
 * call.
 *
 * Descriptions begin with the macro or the function beside them, which sets `struct_size`.
 *
 * NULL: `error` may be, and so may what only gives back further numbers (`bytes`, `count`, ids). Any other NULL is
 * LMN_USAGE; functions without a status give 0, false or NULL then.
 *
 * Units: lengths in the scene's unit, which is that of its first file; angles in degrees, times in seconds, sizes of
 * pictures in pixels with row 0 on top, colours in sRGB with straight alpha.
 *
 * Threads: any. An object is changed by one thread at a time, and by none while others use it; what is handed over as
 * const is only read, so several may do that at once. A renderer is used by one thread at a time; a task belongs to
 * the thread that began it.
 *
 * Errors: LMN_USAGE for arguments, LMN_MEMORY; what reads, draws or writes can also end with LMN_LIMIT
 * (limner/limits.h) and LMN_CANCELLED (limner/task.h). After an error an object can be used as before, or ended.
 *
 * Since: all functions are in 0.1, the first version. */
#ifndef LIMNER_LIMNER_H
#define LIMNER_LIMNER_H

#include "limner/behaviour.h"
#include "limner/content.h"
#include "limner/depict.h"
#include "limner/draw.h"
#include "limner/error.h"
#include "limner/film.h"
#include "limner/host.h"
#include "limner/limits.h"
#include "limner/look.h"
#include "limner/maps.h"
#include "limner/memory.h"
#include "limner/projection.h"
#include "limner/rules.h"
#include "limner/scene.h"
#include "limner/sheet.h"
#include "limner/solid.h"
#include "limner/strokes.h"
#include "limner/task.h"
#include "limner/techniques.h"
#include "limner/version.h"

#endif
