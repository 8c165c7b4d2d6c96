#include "surface/form.h"

#include <math.h>

/* Each reaches two and a half times as far as the one before it, and the later ones less again: surface/form.frag. */
int form_rounds(double radius)
{
    int    wider = 1;
    double reach = 2.5;
    for (; wider < 8 && reach < 0.44 * radius; reach *= 2.5)
        wider++;
    return 2 * wider - 1;
}
