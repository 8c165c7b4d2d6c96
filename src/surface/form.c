#include "surface/form.h"

#include <math.h>

/* Each reaches three times as far as the one before it, and the later ones less again, to the last pixel:
 * surface/form_spread.frag, where a texel stands for two pixels each way. */
int form_rounds(double radius)
{
    int    wider = 1;
    double reach = 3;
    for (; wider < 8 && reach < 0.22 * radius; reach *= 3)
        wider++;
    return 2 * wider;
}
