/* Axes of what is measured: of normals around a cylinder, of a screw motion. */
#ifndef LIMNER_DRAFT_EIGENVECTORS_H
#define LIMNER_DRAFT_EIGENVECTORS_H

/* The eigenvectors of a symmetric matrix of size × size numbers, in the columns of `axes`; its diagonal gets the
 * eigenvalues. Jacobi's rotations, each pair of rows so many rounds. */
void eigenvectors_find(double *axes, double *matrix, int size, int rounds);

#endif
