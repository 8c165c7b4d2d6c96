/* The kind "compose": how a figure's layers and lines meet the page. */
#ifndef LIMNER_COMPOSE_COMPOSE_H
#define LIMNER_COMPOSE_COMPOSE_H

#include "technique/technique.h"

extern const kind kind_compose;

extern const technique compose_opaque, compose_superimpose, compose_merged;

#endif
