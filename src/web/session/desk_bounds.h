/* What may lie on the desk: scenes that are right, name nothing outside of the folder, and ask for a bounded amount of
 * memory and work. The check looks at what a scene names; the limits hold while it is loaded, for what its files name
 * in turn and for triangles, which only files themselves know. files: NULL for anywhere. */
#ifndef CUVETTE_WEB_SESSION_DESK_BOUNDS_H
#define CUVETTE_WEB_SESSION_DESK_BOUNDS_H

#include "web/session/folder.h"

status desk_check(const scene *s, const folder *files, diagnostic *why);
status desk_limit(scene *s, const folder *files, diagnostic *why);

#endif
