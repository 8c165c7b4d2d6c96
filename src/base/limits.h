/* Hard limits on untrusted input, in one place. Printed by `limner doctor` and documented in docs/reference/limits.md.
 * Exceeding one is LMN_LIMIT with the limit in the message, never a crash. */
#ifndef LIMNER_BASE_LIMITS_H
#define LIMNER_BASE_LIMITS_H

#define LIMIT_FILE_BYTES      ((size_t)4 << 30)   /* one input file or side file */
#define LIMIT_VERTICES        ((size_t)200000000) /* of a scene */
#define LIMIT_TRIANGLES       ((size_t)200000000) /* of a scene, before instancing */
#define LIMIT_LINES           ((size_t)200000000) /* of a scene, before instancing: those that files bring */
#define LIMIT_NODES           ((size_t)1000000)
#define LIMIT_INSTANCES       ((size_t)10000000) /* of a scene */
#define LIMIT_NODE_DEPTH      1024               /* of the node tree */
#define LIMIT_IMAGE_SIDE      16384              /* pixels, a texture's width or height */
#define LIMIT_IMAGE_PIXELS    ((size_t)1 << 28)
#define LIMIT_ELEMENTS        ((size_t)400000000) /* values read from glTF accessors, repeated use counted again */
#define LIMIT_ZERO_ELEMENTS   ((size_t)1 << 24)   /* of accessors without a buffer view */
#define LIMIT_JSON_BYTES      ((size_t)1 << 29)   /* a .gltf file, or the JSON chunk of a .glb */
#define LIMIT_JSON_DEPTH      256
#define LIMIT_XML_DEPTH       256 /* of elements in CityGML */
#define LIMIT_GZIP_RATIO      200 /* unpacked bytes for each packed one, beyond LIMIT_GZIP_BYTES */
#define LIMIT_GZIP_BYTES      ((size_t)64 << 20)
#define LIMIT_CSG_DEPTH       1024              /* of blocks and of vectors in .csg files */
#define LIMIT_CSG_VALUES      ((size_t)1 << 25) /* numbers and other values of a .csg file */
#define LIMIT_SCAD_SECONDS    60                /* the openscad process that evaluates a .scad file */
#define LIMIT_POLYGON_CORNERS 65536             /* of one face in PLY, OBJ or a city model */
#define LIMIT_SHAPE_POINTS    ((size_t)4000000) /* of one shape made from numbers */
#define LIMIT_STROKES         1000000           /* of one stroke texture */
#define LIMIT_STROKE_LAYERS   65536
#define LIMIT_STROKE_REACH    16      /* how far from 0 a stroke's ends may lie, squares */
#define LIMIT_MARKS           2000000 /* dots or strokes on the surfaces of one drawing */
#define LIMIT_LOOK_BYTES      ((size_t)4 << 20)
#define LIMIT_LOOK_RULES      256
#define LIMIT_LOOK_TECHNIQUES 64 /* of one kind in a rule */
#define LIMIT_DPI_LEAST       1
#define LIMIT_DPI_MOST        10000
#define LIMIT_PICTURE_SIDE    16384             /* pixels, supersampling counted */
#define LIMIT_IMPORT_SECONDS  120               /* the child process that reads foreign formats */
#define LIMIT_IMPORT_MEMORY   ((size_t)8 << 30) /* its address space */

#endif
