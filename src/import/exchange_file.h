/* Inside the import folder: clear text of ISO 10303-21, which STEP and IFC are both written in. */
#ifndef LIMNER_IMPORT_EXCHANGE_FILE_H
#define LIMNER_IMPORT_EXCHANGE_FILE_H

#include "base/file.h"

typedef enum exchange_kind { EXCHANGE_NONE, EXCHANGE_STEP, EXCHANGE_IFC } exchange_kind;

/* What the schema of its header says that it is of: anything but IFC counts as STEP. EXCHANGE_NONE: it is no such file.
 */
exchange_kind exchange_file_kind(const file_data *file);

#endif
