/* What the functions of the JavaScript API (wasm/exports.h) share: the last error, and results as JSON texts, so that
 * no script depends on the layout of a structure. Ownership: a text is the script's, which frees it; NULL after an
 * error, which results_last keeps. */
#pragma once

#include "base/status.h"
#include "cuvette.h"

#include <jansson.h>

/* Where the functions of cuvette.h that are called from here, and from scripts, put their diagnostic. */
extern cuvette_diagnostic results_last;

/* Keeps the status of a call for wasm_error_json; results_report also the error of a function of the library. */
cuvette_status results_note(cuvette_status code);
cuvette_status results_report(status code, const diagnostic *why);
/* The value as text, which takes the reference; value is NULL when out of memory. */
char *results_text(json_t *value);
/* Three numbers. */
json_t *results_vector(const double v[3]);
