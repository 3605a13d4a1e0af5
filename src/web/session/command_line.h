/* The scene on the desk as the command that renders the same film. */
#ifndef CUVETTE_WEB_SESSION_COMMAND_LINE_H
#define CUVETTE_WEB_SESSION_COMMAND_LINE_H

#include "web/session/folder.h"

/* file: its name in the folder, NULL for none. *complete is false where the file is not there, or has other objects
 * than the scene: no --set can make up for that. threads: what the laboratory gives to scenes that do not say how many
 * they want, and does not count as a difference; 0 for none. text is fresh memory. */
status command_line(const folder *files, const char *file, const scene *s, int threads, char **text, bool *complete,
                    diagnostic *why);

#endif
