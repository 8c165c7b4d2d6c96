/* Inside the import folder: where the module with OpenCASCADE is (step_module.h). It is no part of the program: it is
 * loaded where it is used, in a fenced child of its own (fence_call_prepared), so that nobody who reads no STEP pays
 * for its seventy libraries. */
#ifndef LIMNER_IMPORT_STEP_LIBRARY_H
#define LIMNER_IMPORT_STEP_LIBRARY_H

#include "import/step_module.h"

/* Loads it, before the fence: from the folder that LIMNER_MODULES names, else from where the program is, else from
 * where it was to be installed. */
void step_prepare(void);

/* After that; NULL: there is none, or it is of another version of Limner. */
const step_module *step_library_get(void);

#endif
