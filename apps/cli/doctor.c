/* limner doctor: does Limner work here, with what, and what is missing? */
#include "cli.h"

#include <dlfcn.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct doctor_values {
    bool json;
} doctor_values;

static const option options[] = {
    {"json", 0, OPTION_FLAG, offsetof(doctor_values, json), NULL, "Write JSON (docs/reference/doctor.md)."},
};

/* What drawing needs at run time and the Debian package that brings it: a library, or files. */
typedef struct need {
    const char *what, *library, *files, *package;
} need;

static const need needs[] = {
    {"EGL loader", "libEGL.so.1", NULL, "libegl1"},
    {"OpenGL loader", "libOpenGL.so.0", NULL, "libopengl0"},
    {"EGL vendor", NULL, "/usr/share/glvnd/egl_vendor.d/*.json", "libegl-mesa0"},
    {"OpenGL drivers", NULL, "/usr/lib/*/dri/*_dri.so", "libgl1-mesa-dri"},
};

static bool is_there(const need *n)
{
    if (n->library) {
        void *handle = dlopen(n->library, RTLD_LAZY | RTLD_LOCAL);
        if (handle)
            dlclose(handle);
        return handle != NULL;
    }
    glob_t found = {0};
    bool   any = glob(n->files, 0, NULL, &found) == 0;
    globfree(&found);
    return any;
}

/* What is not there; asked only when no context could be made, since a host may bring other drivers. */
static json_t *find_missing(void)
{
    json_t *list = json_array();
    for (size_t i = 0; i < OPTION_COUNT(needs); i++)
        if (!is_there(&needs[i]))
            json_array_append_new(list, json_pack("{s:s, s:s}", "what", needs[i].what, "package", needs[i].package));
    return list;
}

/* "sudo apt-get install a b": what is missing, or all that drawing without a GPU needs. */
static void put_remedy(json_t *root, const json_t *missing)
{
    char    line[256] = "sudo apt-get install";
    size_t  i;
    json_t *item;
    json_array_foreach((json_t *)missing, i, item)
    {
        size_t length = strlen(line);
        snprintf(line + length, sizeof line - length, " %s", text_at(item, "package", ""));
    }
    if (json_array_size(missing) == 0)
        snprintf(line, sizeof line, "sudo apt-get install --reinstall libegl1 libegl-mesa0 libgl1-mesa-dri");
    json_object_set_new(root, "remedy", json_string(line));
}

/* Objects as indented lines, one value each. */
static void print_values(const json_t *value, int indent)
{
    const char *key;
    json_t     *item;
    size_t      i;
    json_object_foreach((json_t *)value, key, item)
    {
        printf("%*s%-*s", indent, "", indent ? 28 : 30, key);
        if (json_is_object(item)) {
            printf("\n");
            print_values(item, indent + 2);
            continue;
        }
        if (json_is_string(item))
            printf(" %s", json_string_value(item));
        else if (json_is_number(item))
            printf(" %.10g", json_number_value(item));
        else if (json_is_array(item))
            printf(" ");
        else
            printf(" %s", json_is_true(item) ? "yes" : json_is_false(item) ? "no" : "none");
        json_t *element;
        json_array_foreach(item, i, element)
        {
            if (json_is_string(element))
                printf("%s%s", i ? ", " : "", json_string_value(element));
            else if (json_is_number(element))
                printf("%s%.10g", i ? ", " : "", json_number_value(element));
        }
        printf("\n");
    }
}

/* {"time": {"standard": "600s", "safe": "30s", "doc": …}, …} */
static json_t *list_limits(void)
{
    json_t        *list = json_object();
    lmn_limit_info info;
    for (size_t i = 0; lmn_limit_at(i, &info); i++)
        json_object_set_new(
            list, info.name,
            json_pack("{s:s, s:s, s:s}", "standard", info.standard, "safe", info.safe, "doc", info.doc));
    return list;
}

static void print_limits(const json_t *list)
{
    const char *name;
    json_t     *limit;
    printf("\nlimits (--limit NAME=VALUE)    standard   --safe\n");
    json_object_foreach((json_t *)list, name, limit)
        printf("  %-28s %-10s %s\n", name, text_at(limit, "standard", ""), text_at(limit, "safe", ""));
}

/* [{"ending": ".mp4", "usable": true, …}, …] */
static json_t *list_films(void)
{
    json_t              *list = json_array();
    lmn_film_format_info f;
    for (size_t i = 0; lmn_film_format_at(i, &f); i++)
        json_array_append_new(list, json_pack("{s:s, s:b, s:s?, s:s?, s:s}", "ending", f.ending, "usable", f.usable,
                                              "program", f.program, "package", f.package, "doc", f.doc));
    return list;
}

static void print_films(const json_t *list)
{
    size_t  i;
    json_t *film;
    printf("\nfilms (--frames FIRST:LAST:FPS -o NAME.mp4)\n");
    json_array_foreach((json_t *)list, i, film)
    {
        const char *program = text_at(film, "program", NULL), *package = text_at(film, "package", "");
        printf("  %-28s ", text_at(film, "ending", ""));
        if (json_is_true(json_object_get(film, "usable")))
            printf("yes\n");
        else if (program)
            printf("no: %s is missing (sudo apt-get install %s)\n", program, package);
        else
            printf("no: built without %s\n", package);
    }
}

/* The newest GDAL that is installed; the library looks for the same names (src/import/geodata_library.c). */
static void *load_gdal(void)
{
    enum { NEWEST = 45, OLDEST = 26 };
    char  name[32];
    void *found = NULL;
    for (int i = NEWEST; i >= OLDEST && !found; i--) {
        snprintf(name, sizeof name, "libgdal.so.%d", i);
        found = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
    }
    return found ? found : dlopen("libgdal.so", RTLD_LAZY | RTLD_LOCAL);
}

/* {"gdal": "3.6.2", "proj": "9.1.1", "package": …}; null: not installed. Reading runs it in a fenced process; here it
 * is asked for its version alone. */
static json_t *find_geodata(void)
{
    const char *(*release)(const char *) = NULL;
    void (*proj)(int *, int *, int *) = NULL;
    void   *gdal = load_gdal();
    json_t *out = json_pack("{s:n, s:n, s:s}", "gdal", "proj", "package", "gdal-bin");
    if (gdal) {
        *(void **)&release = dlsym(gdal, "GDALVersionInfo");
        *(void **)&proj = dlsym(gdal, "OSRGetPROJVersion");
    }
    if (release)
        json_object_set_new(out, "gdal", json_string(release("RELEASE_NAME")));
    if (proj) {
        char text[64];
        int  v[3] = {0};
        proj(&v[0], &v[1], &v[2]);
        snprintf(text, sizeof text, "%d.%d.%d", v[0], v[1], v[2]);
        json_object_set_new(out, "proj", json_string(text));
    }
    return out; /* it stays loaded to the end: some of its libraries do not survive being unloaded */
}

static void print_geodata(const json_t *found)
{
    static const struct {
        const char *key, *name, *what;
    } rows[] = {{"gdal", "GDAL", "GeoPackage, shapefiles, OpenStreetMap extracts and terrain"},
                {"proj", "PROJ", "terrain and models in different coordinate systems"}};
    printf("\ngeodata\n");
    for (size_t i = 0; i < OPTION_COUNT(rows); i++) {
        const char *version = text_at(found, rows[i].key, NULL);
        printf("  %-28s ", rows[i].name);
        if (version)
            printf("%s\n", version);
        else
            printf("no: %s need it (sudo apt-get install %s)\n", rows[i].what, text_at(found, "package", ""));
    }
}

/* {"opencascade": "7.6.3", "package": …}; null: not there. */
static json_t *find_step(void)
{
    char   *version = lmn_step_version();
    json_t *out = json_pack("{s:s?, s:s}", "opencascade", version, "package", "limner-step");
    lmn_text_free(version);
    return out;
}

static void print_step(const json_t *found)
{
    const char *version = text_at(found, "opencascade", NULL);
    printf("\nSTEP, IGES\n  %-28s ", "OpenCASCADE");
    if (version)
        printf("%s\n", version);
    else
        printf("no: STEP and IGES files need it (package %s, or build Limner with libocct-data-exchange-dev)\n",
               text_at(found, "package", ""));
}

static int print_report(json_t *root, bool as_json, bool usable)
{
    if (as_json) {
        char *text = json_dumps(root, JSON_INDENT(2));
        int   status = text ? store_text("-", text) : message_out_of_memory();
        free(text);
        return status == EXIT_DONE ? store_text("-", "\n") : status;
    }
    printf("limner %s\n", text_at(root, "limner", ""));
    if (usable) {
        print_values(json_object_get(root, "gl"), 0);
        printf("\ndecoders\n");
        print_values(json_object_get(root, "decoders"), 2);
        print_geodata(json_object_get(root, "geodata"));
        print_step(json_object_get(root, "step"));
        print_films(json_object_get(root, "films"));
        print_limits(json_object_get(root, "limits"));
        printf("\nLimner can draw here.\n");
        return EXIT_DONE;
    }
    size_t  i;
    json_t *item;
    printf("Limner cannot draw here: %s\n", text_at(root, "error", ""));
    json_array_foreach(json_object_get(root, "missing"), i, item)
        printf("missing: %s (%s)\n", text_at(item, "what", ""), text_at(item, "package", ""));
    printf("to get it: %s\n", text_at(root, "remedy", ""));
    return EXIT_DONE;
}

static int run(const word_list *inputs, const void *values)
{
    const doctor_values *v = values;
    (void)inputs;
    lmn_error         error = {0};
    lmn_renderer     *renderer = NULL;
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    json_t           *root = json_pack("{s:s}", "limner", lmn_version()), *missing = NULL;
    if (!root)
        return message_out_of_memory();
    bool usable = lmn_renderer_create(&renderer, &desc, &error) == LMN_OK;
    json_object_set_new(root, "usable", json_boolean(usable));
    if (usable) {
        json_t *gl = parse_and_free(lmn_renderer_json(renderer));
        json_object_del(gl, "limner"); /* stands above already */
        json_object_set_new(root, "gl", gl);
        missing = json_array();
    } else {
        json_object_set_new(root, "gl", json_null());
        json_object_set_new(root, "error", json_string(error.message));
        missing = find_missing();
        put_remedy(root, missing);
    }
    json_object_set_new(root, "missing", missing);
    json_object_set_new(root, "decoders", json_pack("{s:s}", "fence", lmn_fence_kind()));
    json_object_set_new(root, "geodata", find_geodata());
    json_object_set_new(root, "step", find_step());
    json_object_set_new(root, "films", list_films());
    json_object_set_new(root, "limits", list_limits());
    lmn_renderer_destroy(&renderer);
    int status = print_report(root, v->json, usable);
    json_decref(root);
    return status != EXIT_DONE ? status : usable ? EXIT_DONE : EXIT_GL;
}

const command command_doctor = {
    .name = "doctor",
    .summary = "Tell whether Limner works here, with which driver, and what is missing.",
    .options = options,
    .option_count = OPTION_COUNT(options),
    .values_size = sizeof(doctor_values),
    .inputs_min = 0,
    .inputs_max = 0,
    .run = run,
};
