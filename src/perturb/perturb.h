/* The kind "perturb": how exactly things are drawn. A technique moves the places where a figure's maps are looked up. */
#ifndef LIMNER_PERTURB_PERTURB_H
#define LIMNER_PERTURB_PERTURB_H

#include "technique/technique.h"

extern const kind kind_perturb;

extern const technique perturb_uncertainty, perturb_pencil;

#endif
