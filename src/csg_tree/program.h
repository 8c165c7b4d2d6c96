/* A solid's tree as a program: what evaluates it, here and in shaders, counts what holds at each term. Roth 1982;
 * Nienhaus et al. 2006, section 2; rows K01–K04. */
#ifndef LIMNER_CSG_TREE_PROGRAM_H
#define LIMNER_CSG_TREE_PROGRAM_H

#include "csg_tree/form.h"

/* Operands and terms of several solids as one list of links, two numbers each. Operands come first: the link to the
 * term above, and the number of its solid. Then the terms: the link, and how many of its operands must hold more
 * than when nothing is there (1 for a union). A link is (term + 1) · 2 + 1 if what is below is negated for the
 * term; 0 ends. Operands are numbered from 1 over all solids. */
typedef struct csg_program {
    uint32_t (*operands)[2];
    bool  *taken_away; /* per operand */
    size_t operand_count, operand_capacity, taken_capacity;
    uint32_t (*terms)[2];
    size_t term_count, term_capacity;
    size_t solid_count;
} csg_program;

/* Adds a solid; its operands get consecutive numbers from operand_count + 1 on, in the order of solid_form_used.
 * False when memory is gone. */
bool csg_program_add(csg_program *p, const solid_form *form);
void csg_program_release(csg_program *p);

#endif
