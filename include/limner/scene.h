/* Scenes: what is drawn. A tree of nodes with meshes, materials, cameras, lights and animations. */
#ifndef LIMNER_SCENE_H
#define LIMNER_SCENE_H

#include "limner/error.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lmn_scene lmn_scene;

/* Which of the file's axes points up. AUTO takes the convention of the format. */
typedef enum lmn_up_axis { LMN_UP_AUTO = 0, LMN_UP_Y, LMN_UP_Z } lmn_up_axis;

/* Is this the importer's format? Asked with the file's bytes, of which there is one at least. */
typedef bool (*lmn_probe_fn)(const void *bytes, size_t size, void *user);

/* Fills an empty scene from the file's bytes, by calls of limner/content.h and limner/solid.h; `path` is for messages.
 * It neither draws nor destroys the scene nor keeps anything of it. On failure it answers another status than LMN_OK
 * and best fills the error (lmn_error.line, too); then the scene's content does not matter. `error` is never NULL. */
typedef lmn_status (*lmn_import_fn)(lmn_scene *scene, const char *path, const void *bytes, size_t size, void *user,
                                    lmn_error *error);

/* A format that the program reads itself. Initialise with LMN_IMPORTER_INIT. Since 0.1. */
typedef struct lmn_importer {
    size_t        struct_size;
    const char   *name;    /* in messages */
    const char   *endings; /* ".off .coff": without `probe`, files with one of these are its own */
    lmn_probe_fn  probe;   /* says which files are, whatever their ending; NULL: the endings do */
    lmn_import_fn read;
    void         *user;
} lmn_importer;
#define LMN_IMPORTER_INIT                                                                                              \
    {                                                                                                                  \
        sizeof(lmn_importer), NULL, NULL, NULL, NULL, NULL                                                             \
    }

/* How a file is read. Initialise with LMN_LOAD_DESC_INIT. */
typedef struct lmn_load_desc {
    size_t struct_size; /* set by LMN_LOAD_DESC_INIT */
    lmn_up_axis
        up_axis; /* LMN_UP_AUTO: glTF, BVH are +Y up, STL, 3MF, STEP, IGES, IFC, OpenSCAD +Z; of OBJ and PLY guessed */
    lmn_progress_fn progress; /* NULL: silent */
    void           *progress_user;
    /* Of OpenSCAD programs (.scad) alone; refused with others. */
    const char *const *defines; /* "NAME=VALUE": variables that replace those of the program */
    size_t             define_count;
    bool               strict; /* openscad's warnings are errors */
    /* Formats of the caller's, asked in this order before Limner's own; not for files that models name. Since 0.1. */
    const lmn_importer *const *importers;
    size_t                     importer_count;
    /* Of city models (CityJSON, CityGML) alone; refused with others. "2" or "2.2": the most detailed geometry of each
     * object that is not more detailed than that. NULL: the most detailed. Since 0.1. */
    const char *lod;
    /* Of models that say where they lie (CityJSON, CityGML, GeoJSON and other footprints) alone; refused with others. A
     * raster of heights (GeoTIFF, HGT, ESRI's ASCII grid), read with GDAL, that lies below the model: footprints and
     * what is between them are put on it. NULL: none. Since 0.1. */
    const char *terrain;
    /* Of footprints alone; refused with others: how densely people, cars, lamps and trees are put along roads, 1 as in
     * an ordinary town, up to 4. 0: only those in the file. Since 0.1. */
    double populate;
    /* Of models with curved surfaces (STEP, IGES) alone; refused with others: how far triangles and lines may lie off
     * them, millimetres. 0: a 2000th of the diagonal of each part's box. Since 0.1. */
    double deflection;
} lmn_load_desc;
#define LMN_LOAD_DESC_INIT                                                                                             \
    {                                                                                                                  \
        sizeof(lmn_load_desc), LMN_UP_AUTO, NULL, NULL, NULL, 0, false, NULL, 0, NULL, NULL, 0, 0                      \
    }

/* What `lmn_scene_info_of` tells. Lengths in the file's unit; bounds are of the rest pose in the scene's axes. */
typedef struct lmn_scene_info {
    size_t   parts, nodes, meshes, materials, textures, cameras, lights, animations, skins;
    uint64_t triangles, lines;             /* instances counted; lines: those that files bring */
    double   bounds_min[3], bounds_max[3]; /* all 0 when the scene is empty */
    char     up;                           /* 'y' or 'z' */
} lmn_scene_info;

/* A part: a node with geometry. Parts are numbered from 1, depth-first in input order. */
typedef struct lmn_part_info {
    uint32_t    id;
    const char *name; /* node name, else mesh name, else "part-ID"; borrowed from the scene */
    const char *path; /* names from the root joined by '/'; borrowed */
    uint64_t    triangles, lines;
    size_t      instances;
    double      bounds_min[3], bounds_max[3];
} lmn_part_info;

/* Makes an empty scene; end it with lmn_scene_destroy. Errors: LMN_MEMORY. No GL context needed. */
LMN_API lmn_status lmn_scene_create(lmn_scene **out, lmn_error *error);

/* Frees a scene and sets the handle to NULL; NULL and a pointer to NULL are accepted. */
LMN_API void lmn_scene_destroy(lmn_scene **scene);

/* Reads a model file and adds its content under a new root. The first file decides the scene's up axis; later ones are
 * rotated to it. Motion capture whose joints are called like those of a skin in the scene becomes an animation of these
 * and adds nothing else. On any error the scene is unchanged.
 * Errors: LMN_USAGE (desc), LMN_READ, LMN_FORMAT, LMN_LIMIT, LMN_UNSUPPORTED, LMN_MEMORY, LMN_CANCELLED.
 * No GL context needed; different scenes may be loaded on different threads. */
LMN_API lmn_status lmn_scene_add_file(lmn_scene *scene, const char *path, const lmn_load_desc *desc, lmn_error *error);

/* Counts and bounds of the scene in its rest pose. */
LMN_API lmn_scene_info lmn_scene_info_of(const lmn_scene *scene);

/* The part with this index (0 … parts−1). Strings live as long as the scene is not changed. False when out of
 * range. */
LMN_API bool lmn_scene_part_at(const lmn_scene *scene, size_t index, lmn_part_info *out);

/* Everything about the scene as JSON text (documented in docs/reference/info.md); free with lmn_text_free.
 * NULL when memory is gone. */
LMN_API char *lmn_scene_info_json(const lmn_scene *scene);

/* What happens in the scene as JSON text: for each node that moves or is something, what it is, what drives it when,
 * and where it goes (documented in docs/reference/info.md); free with lmn_text_free. NULL when memory is gone, or when
 * the behaviour of a script is none that can be laid out. */
LMN_API char *lmn_scene_dynamics_json(const lmn_scene *scene);

/* The version of OpenCASCADE, which STEP and IGES files are read with; free with lmn_text_free. NULL when it is not
 * installed, or memory is gone. A child process loads it and is asked. Any thread. Since 0.1. */
LMN_API char *lmn_step_version(void);

/* Frees text that Limner returned. NULL is accepted. */
LMN_API void lmn_text_free(char *text);

/* Writes text into a file, whole or not at all; "-" is standard output. Errors: LMN_USAGE, LMN_WRITE, LMN_MEMORY. */
LMN_API lmn_status lmn_text_write(const char *text, const char *path, lmn_error *error);

#ifdef __cplusplus
}
#endif
#endif
