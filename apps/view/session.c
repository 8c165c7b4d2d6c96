#include "session.h"

#include <glib/gstdio.h>

static char *file_name(void)
{
    return g_build_filename(g_get_user_state_dir(), "limner", "viewer.ini", NULL);
}

static bool read_view(GKeyFile *file, orbit *o)
{
    gsize   count = 0;
    double *v = g_key_file_get_double_list(file, "view", "orbit", &count, NULL);
    char   *up = g_key_file_get_string(file, "view", "up", NULL);
    bool    good = v && count == 7 && up && (*up == 'y' || *up == 'z') && v[5] > 0 && v[6] >= 1 && v[6] <= 170;
    if (good)
        *o = (orbit){
            {v[0], v[1], v[2]}, v[3], v[4], v[5], v[6], g_key_file_get_boolean(file, "view", "parallel", NULL), *up};
    g_free(v);
    g_free(up);
    return good;
}

session session_read(void)
{
    session   s = {.lists = true, .panel = true};
    GKeyFile *file = g_key_file_new();
    char     *name = file_name();
    if (g_key_file_load_from_file(file, name, G_KEY_FILE_NONE, NULL)) {
        s.paths = g_key_file_get_string_list(file, "model", "paths", NULL, NULL);
        s.look = g_key_file_get_string(file, "look", "json", NULL);
        s.has_view = read_view(file, &s.view);
        s.width = CLAMP(g_key_file_get_integer(file, "window", "width", NULL), 0, 16384);
        s.height = CLAMP(g_key_file_get_integer(file, "window", "height", NULL), 0, 16384);
        s.maximized = g_key_file_get_boolean(file, "window", "maximized", NULL);
        s.lists = g_key_file_get_boolean(file, "window", "lists", NULL);
        s.panel = g_key_file_get_boolean(file, "window", "panel", NULL);
    }
    g_free(name);
    g_key_file_unref(file);
    return s;
}

void session_write(const session *s)
{
    GKeyFile *file = g_key_file_new();
    char     *name = file_name(), *folder = g_path_get_dirname(name);
    if (s->paths)
        g_key_file_set_string_list(file, "model", "paths", (const char *const *)s->paths, g_strv_length(s->paths));
    if (s->look)
        g_key_file_set_string(file, "look", "json", s->look);
    if (s->has_view) {
        const orbit *o = &s->view;
        double       v[7] = {o->target[0], o->target[1], o->target[2], o->yaw, o->pitch, o->distance, o->fov_deg};
        char         up[2] = {o->up, 0};
        g_key_file_set_double_list(file, "view", "orbit", v, G_N_ELEMENTS(v));
        g_key_file_set_string(file, "view", "up", up);
        g_key_file_set_boolean(file, "view", "parallel", o->orthographic);
    }
    g_key_file_set_integer(file, "window", "width", s->width);
    g_key_file_set_integer(file, "window", "height", s->height);
    g_key_file_set_boolean(file, "window", "maximized", s->maximized);
    g_key_file_set_boolean(file, "window", "lists", s->lists);
    g_key_file_set_boolean(file, "window", "panel", s->panel);
    if (g_mkdir_with_parents(folder, 0700) == 0)
        g_key_file_save_to_file(file, name, NULL);
    g_free(folder);
    g_free(name);
    g_key_file_unref(file);
}

void session_clear(session *s)
{
    g_clear_pointer(&s->paths, g_strfreev);
    g_clear_pointer(&s->look, g_free);
}
