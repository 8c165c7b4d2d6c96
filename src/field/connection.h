/* A quantity at each of many nodes that is a complex number in a frame of the node's own, as smooth over the links
 * between them as what is known of some allows: the minimum of Σ w |u_i − r_ij u_j|² + Σ c_i |u_i − q_i|², which is one
 * linear system (Knöppel et al. 2013, "Globally optimal direction fields"). It is solved from coarse to fine over
 * groups of nodes that grow pair by pair, after the fields of Jakob et al. 2015 ("Instant field-aligned meshes");
 * unlike there u keeps its length, which says how sure it is, so that what is known wins over what is not. */
#ifndef LIMNER_FIELD_CONNECTION_H
#define LIMNER_FIELD_CONNECTION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct complex_number {
    float re, im;
} complex_number;

/* A link as one node has it: the other node, and w r: how strongly, and by how much what the other has is turned on the
 * way here. */
typedef struct connection_link {
    uint32_t       other;
    complex_number pull;
} connection_link;

/* Nodes with links: those of node i are links[starts[i]] … links[starts[i + 1] − 1], each from both sides. */
typedef struct connection {
    uint32_t         count;
    uint32_t        *starts;
    connection_link *links;
    float           *links_hold; /* per node: Σ w */
    float           *hold;       /* per node: c */
    complex_number  *source;     /* per node: c q */
} connection;

/* Fills u. The same numbers whatever the machine has of threads. False when memory is gone or work is to stop. */
bool connection_solve(const connection *c, complex_number *u);

/* `sweeps` more steps (Gauss–Seidel) from the u that is there; nodes that are `fixed` (NULL: none) keep theirs. */
void connection_relax(const connection *c, complex_number *u, const bool *fixed, int sweeps);

void connection_release(connection *c);

static inline complex_number complex_product(complex_number a, complex_number b)
{
    return (complex_number){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

static inline complex_number complex_conjugate(complex_number a)
{
    return (complex_number){a.re, -a.im};
}

#endif
