#include "command.h"
GStrv command_words(const view_state *s, const scene_ref *scene, const export_wish *wish, lmn_error *error)
{
    (void)s;
    (void)scene;
    (void)wish;
    (void)error;
    return NULL;
}
char *command_line(const char *const *words)
{
    (void)words;
    return NULL;
}
char *command_in_c(const view_state *s, const scene_ref *scene, const export_wish *wish, lmn_error *error)
{
    (void)s;
    (void)scene;
    (void)wish;
    (void)error;
    return NULL;
}
