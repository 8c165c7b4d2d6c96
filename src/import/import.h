/* Import: files to scenes. One file a format; import.c holds the table. */
#ifndef LIMNER_IMPORT_IMPORT_H
#define LIMNER_IMPORT_IMPORT_H

#include "base/file.h"
#include "scene/scene.h"

/* What a reader gets: the file's bytes, its path for side files and messages, and an empty scene to fill. */
typedef struct import_job {
    const char          *path;
    const char          *model; /* the path that the caller gave; another one in files that it imports */
    file_data           *file;  /* readers may cut off what they have read */
    lmn_scene           *scene;
    const lmn_load_desc *desc; /* what only one format has; NULL: nothing */
} import_job;

typedef struct import_format {
    const char *name;                          /* "glTF" */
    const char *endings;                       /* ".gltf .glb" */
    char        up;                            /* the format's convention: 'y' or 'z' */
    bool        up_guessed;                    /* which is no rule: files have either (up_axis.h) */
    bool (*recognises)(const file_data *file); /* by content; NULL: by ending only */
    lmn_status (*read)(const import_job *job, lmn_error *error);
    bool curved; /* its surfaces become triangles here, as fine as a deflection says */
} import_format;

extern const import_format import_gltf, import_stl, import_ply, import_obj, import_bvh, import_csg, import_scad,
    import_script, import_cityjson, import_citygml, import_geojson, import_geodata, import_step, import_iges,
    import_ifc, import_assimp;

/* Reads a file into a new finished scene (owned by the caller). The description is complete; LMN_UP_AUTO takes the
 * format's convention. Content decides the format first, the ending second; a mismatch is an error that says so. */
lmn_status import_file(lmn_scene **out, const char *path, const lmn_load_desc *desc, lmn_error *error);
/* The same of a file that the job's model names; `path` is relative to the working directory. */
lmn_status import_named_file(lmn_scene **out, const import_job *job, const char *path, lmn_error *error);

/* Tells how far reading is. LMN_CANCELLED or LMN_LIMIT when it is to stop, then the error names the file. */
lmn_status import_progress(const import_job *job, double fraction, const char *stage, lmn_error *error);

#endif
