/* Inside the import folder: the syntax of OpenSCAD's evaluated files (.csg) as a tree. Nodes and values are kept in
 * the order of the text, so that all below one is the run up to its `after`. Nienhaus et al. 2006, section 2. */
#ifndef LIMNER_IMPORT_CSG_TREE_H
#define LIMNER_IMPORT_CSG_TREE_H

#include "import/import.h"

typedef enum csg_kind { CSG_UNDEF, CSG_BOOL, CSG_NUMBER, CSG_STRING, CSG_VECTOR } csg_kind;

typedef struct csg_value {
    csg_kind kind;
    uint32_t count; /* vector: elements; string: bytes */
    int32_t  after; /* the value behind it and all it holds */
    union {
        bool   truth;
        double number;
        size_t string; /* in the tree's text */
    } as;
} csg_value;

typedef struct csg_argument {
    size_t  name; /* in the tree's text; 0: given by position */
    int32_t value;
} csg_argument;

enum { CSG_SHOWN = 1 /* # */, CSG_BACKGROUND = 2 /* % */, CSG_DISABLED = 4 /* * */, CSG_ROOT = 8 /* ! */ };

typedef struct csg_node {
    size_t   word; /* in the tree's text: "cube"; 0 of the root */
    uint32_t line;
    uint8_t  modifiers, dimension; /* 2, 3, 0 when there is nothing; set by the reader */
    int32_t  after;
    int32_t  first_argument, argument_count, first_value, value_count;
    uint64_t hash; /* of all it says, children too, its position in the file apart */
} csg_node;

typedef struct csg_tree {
    csg_node     *nodes; /* 0 is the root, which stands for the file */
    size_t        node_count, node_capacity;
    csg_argument *arguments;
    size_t        argument_count, argument_capacity;
    csg_value    *values;
    size_t        value_count, value_capacity;
    char         *text; /* words, names and strings, each with a NUL behind; "" at 0 */
    size_t        text_size, text_capacity;
} csg_tree;

/* Parses the job's file. Errors: LMN_FORMAT with line and column, LMN_LIMIT, LMN_MEMORY, LMN_CANCELLED. Release it
 * also after one. */
lmn_status csg_parse(csg_tree *out, const import_job *job, lmn_error *error);
void       csg_release(csg_tree *tree);

/* The first child and the next one, NONE at the end. */
int32_t     csg_first_child(const csg_tree *tree, int32_t node);
int32_t     csg_next_child(const csg_tree *tree, int32_t parent, int32_t child);
const char *csg_word(const csg_tree *tree, int32_t node);
/* Do both say the same, children too? */
bool csg_equal(const csg_tree *tree, int32_t a, int32_t b);

/* --- csg_arguments.c: what a node is told --------------------------------------------------------------- */

/* The value given by this name, or as the n-th without a name (from 0; NONE: by name only). NONE when absent or
 * undef. */
int32_t csg_argument_value(const csg_tree *tree, int32_t node, const char *name, int position);
/* The same as a type; `otherwise` when absent or of another type. */
double      csg_number(const csg_tree *tree, int32_t node, const char *name, int position, double otherwise);
bool        csg_bool(const csg_tree *tree, int32_t node, const char *name, int position, bool otherwise);
const char *csg_string(const csg_tree *tree, int32_t node, const char *name, int position, const char *otherwise);
/* Numbers of a vector into `out`, which keeps its content where there are none; one number alone stands for all
 * when `spread`. Returns how many the vector has; 0 when absent. */
uint32_t csg_numbers(const csg_tree *tree, int32_t node, const char *name, int position, double *out, uint32_t count,
                     bool spread);
/* Numbers of a vector value; those missing keep what `out` has. */
void csg_vector_numbers(const csg_tree *tree, int32_t value, double *out, uint32_t count);
/* Are all numbers that the node is told finite? */
bool csg_all_finite(const csg_tree *tree, int32_t node);

#endif
