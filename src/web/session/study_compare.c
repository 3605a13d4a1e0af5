/* Compares two runs of one study for the laboratory, as `cuvette study compare` does. */
#include "study/contrast_json.h"
#include "web/api/study_json.h"

status study_json_compare(const study *s, const char *results, const char *other, json_t **out, diagnostic *why)
{
    const study_side a = side_of_folder(results), b = side_of_folder(other);
    contrast *made = NULL;
    *out = NULL;
    TRY(contrast_make(s, &a, &b, &(contrast_options){.column = NULL}, &made, NULL, why));
    *out = contrast_json(s, made, STUDY_JSON_CELLS_MAX);
    contrast_destroy(made);
    return *out ? STATUS_OK : out_of_memory(why);
}
