/* The laboratory within a page (report/page.h): live.html, which `make site` makes, compressed (zlib) as base64, and
 * the script that starts it with the page's scene. Ownership: results are the caller's, freed with free. */
#pragma once

#include "base/status.h"
#include <stdio.h>

#define PAGE_LIVE_FILE "live.html"

/* The path of live.html, the first that exists: $CUVETTE_LIVE (only this one if it is set); the folder of the running
 * program; ../share/cuvette relative to it, where `make install` puts it. NULL: there is none, or with ENOMEM. */
char *page_live_path(void);

/* STATUS_BAD_INPUT with the remedy where there is no live.html. */
status page_live_code(char **code, diagnostic *why);

/* The button, the code and the script. "" is a place for the code that something else fills in. */
void page_live_write(const char *code, FILE *out);
