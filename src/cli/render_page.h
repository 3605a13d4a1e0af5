/* The page of a rendered scene (report/page.h), for `cuvette render -o FILE.html`. Everything is borrowed. */
#pragma once

#include "cli/scene_input.h"

/* Written completely or not at all. live: with the laboratory (report/page.h), NULL for none. */
status render_page_write(const scene_input *input, const job_account *f, isa level, const char *path, int bits,
                         const char *live, diagnostic *why);
