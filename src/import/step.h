/* Inside the import folder: from what the module answers to a scene. */
#ifndef LIMNER_IMPORT_STEP_H
#define LIMNER_IMPORT_STEP_H

#include "import/import.h"
#include "import/step_module.h"

/* Checks the bytes (step_module.h) of such a file and fills the job's scene. Errors: LMN_FORMAT, LMN_LIMIT, LMN_MEMORY.
 */
lmn_status step_answer_read(const import_job *job, step_kind kind, const unsigned char *bytes, size_t size,
                            lmn_error *error);

/* The version of the library, asked in a child; free with mem_free. NULL: there is none, or no memory. */
char *step_version(void);

#endif
