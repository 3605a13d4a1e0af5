/* The files of the page (src/web/page/), embedded in the program by the Makefile under their names, for
 * http_settings.files. Constants; no ownership, no errors. */
#pragma once

#include "web/http/http.h"

extern const http_file page_files[];
extern const size_t page_file_count;
