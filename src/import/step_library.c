#define _GNU_SOURCE /* dladdr */
#include "import/step_library.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MODULE "limner-step.so"

enum { PATH_CAPACITY = 4096 };

/* The n-th place to look in; false: there is none, or no more of them. */
static bool place(int n, char *out, bool *more)
{
    static const char anchor;
    const char       *given = secure_getenv("LIMNER_MODULES");
    Dl_info           own = {0};
    const char       *file = dladdr(&anchor, &own) ? own.dli_fname : NULL, *slash = file ? strrchr(file, '/') : NULL;
    int               folder = slash ? (int)(slash - file) : 0, length = -1;
    *more = n < 3;
    if (n == 0 && given)
        length = snprintf(out, PATH_CAPACITY, "%s/" MODULE, given);
    else if (n == 1 && slash)
        length = snprintf(out, PATH_CAPACITY, "%.*s/limner/" MODULE, folder, file);
    else if (n == 2 && slash)
        length = snprintf(out, PATH_CAPACITY, "%.*s/" MODULE, folder, file);
#ifdef LIMNER_MODULE_FOLDER
    else if (n == 3)
        length = snprintf(out, PATH_CAPACITY, "%s/" MODULE, LIMNER_MODULE_FOLDER);
#endif
    return length > 0 && length < PATH_CAPACITY;
}

static const step_module *find(int flags)
{
    bool more = true;
    for (int n = 0; more; n++) {
        char  path[PATH_CAPACITY];
        void *found = place(n, path, &more) ? dlopen(path, RTLD_NOW | RTLD_LOCAL | flags) : NULL;
        if (!found)
            continue;
        const step_module *module = dlsym(found, "limner_step_module");
        if (module && module->interface == STEP_INTERFACE)
            return module;
    }
    return NULL;
}

const step_module *step_library_get(void)
{
    return find(RTLD_NOLOAD);
}

void step_prepare(void)
{
    const step_module *module = find(0);
    if (module)
        module->prepare();
}
