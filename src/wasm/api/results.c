/* Stores the last error, and converts results to JSON texts. */
#include "wasm/api/results.h"
#include "base/json_build.h"
#include "engine/engine_private.h"
#include "report/json.h"
#include "wasm/exports.h"

cuvette_diagnostic results_last;

static cuvette_status last_status;

cuvette_status results_note(cuvette_status code)
{
    last_status = code;
    return code;
}

cuvette_status results_report(status code, const diagnostic *why)
{
    return results_note(engine_report(code, why, &results_last));
}

char *results_text(json_t *value)
{
    char *text = value ? json_text(value, JSON_COMPACT | JSON_ENCODE_ANY | JSON_REAL_PRECISION(17)) : NULL;
    json_decref(value);
    if (!text) {
        diagnostic why = {.line = 0};
        results_report(out_of_memory(&why), &why);
    }
    return text;
}

json_t *results_vector(const double v[3])
{
    return json_pack("[o,o,o]", json_of_real(v[0]), json_of_real(v[1]), json_of_real(v[2]));
}

cuvette_diagnostic *wasm_error(void)
{
    return &results_last;
}

char *wasm_error_json(void)
{
    char text[CUVETTE_DIAGNOSTIC_TEXT_MAX];
    const cuvette_diagnostic *e = &results_last;
    cuvette_diagnostic_text(e, text, sizeof text);
    return results_text(json_pack("{s:i,s:o,s:o,s:o,s:o,s:i,s:i}", "status", (int)last_status, "text",
                                  json_of_text(text), "what", json_of_text(e->what), "remedy", json_of_text(e->remedy),
                                  "file", json_of_text(e->file), "line", (int)e->line, "column", (int)e->column));
}
