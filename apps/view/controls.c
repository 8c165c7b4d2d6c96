#include "controls.h"
GtkWidget *controls_new(document *d)
{
    (void)d;
    return gtk_label_new("controls");
}
