/* Inside the import folder: what assimp leaves out of 3MF files (3MF core specification 1.3), the unit of length and
 * the names of objects. */
#ifndef LIMNER_IMPORT_THREEMF_H
#define LIMNER_IMPORT_THREEMF_H

#include "import/import.h"

/* Gives the job's scene, as assimp has filled it, millimetres and names. What cannot be read is a warning. Errors:
 * LMN_MEMORY, and that it is to stop. */
lmn_status threemf_describe(const import_job *job, lmn_error *error);

#endif
