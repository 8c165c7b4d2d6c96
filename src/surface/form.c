#include "surface/form.h"

#include <math.h>

/* Each reaches two and a half times as far as the one before it, and the later ones less again, the last of which is left to finding them on each pixel:
 * surface/form_spread.frag, where a texel stands for two pixels each way. */
int form_rounds(double radius)
{
    int    wider = 1;
    double reach = 2.5;
    for (; wider < 8 && reach < 0.22 * radius; reach *= 2.5)
        wider++;
    return wider > 1 ? 2 * wider - 2 : 1;
}
