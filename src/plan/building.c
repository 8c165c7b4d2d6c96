/* Storeys and use from what files state in words. */
#include "plan/building.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "scene/content.h"

static int storeys_of(const lmn_scene *scene, int32_t node_index)
{
    static const char *const keys[] = {"storeysAboveGround", "building:levels", "storeys"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        const char *value = scene_attribute_of(scene, node_index, keys[i]);
        long        count = value ? strtol(value, NULL, 10) : 0;
        if (count > 0 && count < 1000)
            return (int)count;
    }
    return 0;
}

/* Of the AdV's catalogue of ALKIS objects: 1000 and up are dwellings, 2100 … 2199 trade and industry, other 2000s and
 * the public 3000s have offices and halls like these. */
static building_use use_of_cadastre(const char *code)
{
    long number = strtol(code, NULL, 10);
    return number < 1000        ? USE_UNKNOWN
           : number < 2000      ? USE_RESIDENTIAL
           : number / 100 == 21 ? USE_INDUSTRIAL
           : number < 4000      ? USE_OFFICE
                                : USE_UNKNOWN;
}

static building_use use_of(const char *value)
{
    static const struct {
        const char  *word;
        building_use use;
    } words[] = {
        {"resid", USE_RESIDENTIAL},    {"house", USE_RESIDENTIAL},    {"apartment", USE_RESIDENTIAL},
        {"dwelling", USE_RESIDENTIAL}, {"wohn", USE_RESIDENTIAL},     {"office", USE_OFFICE},
        {"commerc", USE_OFFICE},       {"business", USE_OFFICE},      {"retail", USE_OFFICE},
        {"hotel", USE_OFFICE},         {"school", USE_OFFICE},        {"hospital", USE_OFFICE},
        {"public", USE_OFFICE},        {"verwaltung", USE_OFFICE},    {"geschäft", USE_OFFICE},
        {"industr", USE_INDUSTRIAL},   {"warehouse", USE_INDUSTRIAL}, {"factory", USE_INDUSTRIAL},
        {"gewerbe", USE_INDUSTRIAL},   {"lager", USE_INDUSTRIAL},     {"garage", USE_INDUSTRIAL},
    };
    char lower[80] = "";
    for (size_t i = 0; value[i] && i + 1 < sizeof lower; i++)
        lower[i] = (char)((unsigned char)value[i] < 128 ? tolower((unsigned char)value[i]) : value[i]);
    if (strncmp(lower, "31001_", 6) == 0)
        return use_of_cadastre(lower + 6);
    /* Warehouses are no houses: the longest word decides. */
    building_use found = USE_UNKNOWN;
    size_t       longest = 0;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strlen(words[i].word) > longest && strstr(lower, words[i].word)) {
            found = words[i].use;
            longest = strlen(words[i].word);
        }
    return found;
}

building_facts building_facts_of(const lmn_scene *scene, int32_t node_index)
{
    static const char *const keys[] = {"facade", "function", "usage", "class", "building:use", "building"};
    building_facts           out = {.storeys = storeys_of(scene, node_index)};
    for (size_t i = 0; i < sizeof keys / sizeof *keys && out.use == USE_UNKNOWN; i++) {
        const char *value = scene_attribute_of(scene, node_index, keys[i]);
        out.use = value ? use_of(value) : USE_UNKNOWN;
    }
    return out;
}
