/* The page's files (src/web/page/), which the program carries within itself: the Makefile embeds each under its name.
 * For http_settings.files. Constant; no ownership, cannot fail. */
#pragma once

#include "web/http/http.h"

extern const http_file page_files[];
extern const size_t page_file_count;
