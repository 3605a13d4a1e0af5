/* Script files: recorded hands that act on a slime. YAML:
 *
 *   title: A tug to the left            # optional
 *   hands:
 *     left:                             # any name; each hand holds one place at a time
 *       - {time_s: 0.5, grab: [0, 1, -6], towards: [0, 0, 1], reach: 0.3}   # where this ray (point, direction) hits
 *       - {time_s: 1.5, move: [-1.2, 0.8, 0]}                               # displacement since the grab, at that time
 *       - {time_s: 2.0, release: on}
 *
 * Points are in the frame of the slime's mesh, which is the world's if its solid is not moved, rotated or scaled.
 * Ownership: the caller releases a script with hand_script_destroy. Errors: STATUS_BAD_INPUT with file, line and
 * column. */
#pragma once

#include "softbody/softbody.h"

/* Reads a file below root (base/file.h; NULL: no restriction). */
status script_read_below(const char *path, const char *root, hand_script **out, diagnostic *why);
/* Reads a script from memory; name is used in diagnostics. */
status script_read_text(const char *name, const char *text, size_t size, hand_script **out, diagnostic *why);
