#include "export.h"
void export_open(ViewWindow *w)
{
    (void)w;
}
