/* The browser laboratory: one scene document, a render worker that renders every change, a live slime and studies,
 * served to pages and programs over HTTP (web/http/http.h) by the API of web/README.md. Ownership: lab_start
 * creates, lab_stop releases and joins all threads; the texts in the settings are borrowed until then. Errors:
 * STATUS_BAD_INPUT for an unusable scene, folder or port, STATUS_FAILURE for memory and threads. Prints nothing and
 * handles no signal. */
#pragma once

#include "web/http/http.h"
#include "web/session/session.h"

status lab_start(const lab_settings *settings, lab **out, diagnostic *why);
void lab_stop(lab *l); /* NULL is allowed */
/* Lets an unsaved scene stay on disk at the stop, for the next laboratory to offer; otherwise the stop removes it. */
void lab_leave_unsaved(lab *l);

/* "http://127.0.0.1:PORT/?token=TOKEN" */
const char *lab_address(const lab *l);
/* The HTTP server, for its port and token. */
const struct http_server *lab_server(const lab *l);

/* The files of the page (src/web/page/), embedded in the program by the Makefile under their names, for
 * http_settings.files. Constants; no ownership, no errors. */

extern const http_file page_files[];
extern const size_t page_file_count;
