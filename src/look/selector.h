/* Selectors: which parts a rule draws.
 *   *            every part             Wheel*        glob on the part's name
 *   Truck/\*\/Axle glob on the path (it contains '/')
 *   [key]        has the attribute      [key=glob]    and its value matches; [material=glob] and [id=N] are built in
 *   [key>30]     compared as a number: < <= > >=; [key!=glob]; = and != take 30 and 30.0 for the same. Units behind a
 *                blank are left out ("12.5 m"); dates ("1898-05-02") are their year and the fraction of it
 *   a, b         either                 a [key=x]     both          !a   not
 *   @removed         what a solid's differences take away (ghosts); only selectors that say so match it, '*' does not
 *   @solid           parts that are solids: of set operations, not of triangles
 *   @roof @wall …    what a surface of a city is (scene/city.h): [surface=roof]
 * Quotes keep blanks and commas: "Front Axle", [material="a, b"]. '*' and '?' work inside quotes too, and '*' also runs
 * over '/'. An attribute of a node holds for what is below it.
 */
#ifndef LIMNER_LOOK_SELECTOR_H
#define LIMNER_LOOK_SELECTOR_H

#include "scene/scene.h"

typedef struct selector selector;

/* Errors: LMN_USAGE (what is wrong, where), LMN_MEMORY. */
lmn_status selector_parse(selector **out, const char *text, lmn_error *error);
void       selector_destroy(selector **s);
bool       selector_matches(const selector *s, const lmn_scene *scene, size_t part_index);
/* May it match ghosts? */
bool selector_names_removed(const selector *s);

#endif
