/* The last error of a call from a script: its text, until the next one (wasm_why). */
#pragma once

#include "base/status.h"

/* Keeps the error's text, if there is one. Returns the status as a number. */
int trouble_note(status code, const diagnostic *why);
