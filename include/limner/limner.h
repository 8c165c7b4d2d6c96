/* Limner draws 3D models the way people draw. This header is all of the public API. */
#ifndef LIMNER_LIMNER_H
#define LIMNER_LIMNER_H

#include "limner/content.h"
#include "limner/draw.h"
#include "limner/error.h"
#include "limner/film.h"
#include "limner/host.h"
#include "limner/limits.h"
#include "limner/look.h"
#include "limner/maps.h"
#include "limner/rules.h"
#include "limner/scene.h"
#include "limner/sheet.h"
#include "limner/solid.h"
#include "limner/strokes.h"
#include "limner/task.h"
#include "limner/version.h"

#endif
