#include "draft/eigenvectors.h"

#include <math.h>

/* Turns rows and columns p and q of a symmetric matrix so that the number between them becomes 0. */
static void rotate(double *axes, double *m, int size, int p, int q)
{
    const double between = m[p * size + q];
    if (fabs(between) < 1e-300)
        return;
    double theta = (m[q * size + q] - m[p * size + p]) / (2 * between);
    double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1)), c = 1 / sqrt(t * t + 1), s = t * c;
    for (int k = 0; k < size; k++) {
        double a = m[k * size + p], b = m[k * size + q];
        m[k * size + p] = c * a - s * b;
        m[k * size + q] = s * a + c * b;
    }
    for (int k = 0; k < size; k++) {
        double a = m[p * size + k], b = m[q * size + k];
        m[p * size + k] = c * a - s * b;
        m[q * size + k] = s * a + c * b;
        a = axes[k * size + p];
        b = axes[k * size + q];
        axes[k * size + p] = c * a - s * b;
        axes[k * size + q] = s * a + c * b;
    }
}

void eigenvectors_find(double *axes, double *matrix, int size, int rounds)
{
    for (int i = 0; i < size * size; i++)
        axes[i] = i % (size + 1) == 0;
    for (int round = 0; round < rounds; round++)
        for (int p = 0; p < size; p++)
            for (int q = p + 1; q < size; q++)
                rotate(axes, matrix, size, p, q);
}
