#include "base/error.h"
#include "import/import.h"
static lmn_status read_gltf(const import_job *job, lmn_error *error)
{
    return error_in_file(error, LMN_UNSUPPORTED, job->path, 0, "not yet");
}
const import_format import_gltf = {"glTF", ".gltf .glb", 'y', NULL, read_gltf};
