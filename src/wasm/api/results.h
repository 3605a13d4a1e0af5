/* For all functions of the JavaScript API (wasm/exports.h): the last error, and results as JSON texts, so that no
 * script depends on the layout of a structure. Ownership: the script frees a text. After an error the text is NULL, and
 * results_last has the diagnostic. */
#pragma once

#include "base/status.h"
#include "cuvette.h"

#include <jansson.h>

/* The diagnostic of the last call of a function of cuvette.h, by a file of wasm/api or by a script. */
extern cuvette_diagnostic results_last;

/* Stores the status of a call for wasm_error_json; results_report also stores an internal diagnostic. */
cuvette_status results_note(cuvette_status code);
cuvette_status results_report(status code, const diagnostic *why);
/* Converts the value to text, and releases the value. NULL means that memory ran out, as value and as result. */
char *results_text(json_t *value);
/* An array of three numbers. */
json_t *results_vector(const double v[3]);
