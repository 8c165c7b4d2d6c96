/* What a part's attributes say of it as a building. */
#ifndef LIMNER_PLAN_BUILDING_H
#define LIMNER_PLAN_BUILDING_H

#include "scene/scene.h"

typedef enum building_use { USE_UNKNOWN, USE_RESIDENTIAL, USE_OFFICE, USE_INDUSTRIAL } building_use;

typedef struct building_facts {
    int          storeys; /* 0: unknown */
    building_use use;
} building_facts;

/* Storeys: storeysAboveGround (CityJSON, CityGML), building:levels (OpenStreetMap), storeys. Use: the words in
 * facade, function, usage, class, building:use or building, in English or German, and the numbers of the German
 * cadastre (ALKIS, 31001_nnnn). */
building_facts building_facts_of(const lmn_scene *scene, int32_t node_index);

#endif
