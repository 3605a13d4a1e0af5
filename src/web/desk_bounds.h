/* What may lie on the desk: scenes that are right, name nothing outside of the folder, and ask for a bounded amount of memory and work. Pure but for looking
 * at the folder. */
#ifndef CUVETTE_WEB_DESK_BOUNDS_H
#define CUVETTE_WEB_DESK_BOUNDS_H

#include "web/folder.h"

status desk_check(const scene *s, const folder *files, diagnostic *why);

#endif
