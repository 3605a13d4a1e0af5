/* The browser laboratory: one scene document, a render worker that renders every change, a live slime and studies,
 * served to pages and programs over HTTP (web/http/http.h) by the API of web/README.md. Ownership: lab_start
 * creates, lab_stop releases and joins all threads; the texts in the settings are borrowed until then. Errors:
 * STATUS_BAD_INPUT for an unusable scene, folder or port, STATUS_FAILURE for memory and threads. Prints nothing and
 * handles no signal. */
#pragma once

#include "base/isa.h"
#include "scene/model/open.h"

typedef struct lab lab;

typedef struct lab_settings {
    const char *folder; /* nothing outside it is read or written */
    /* Scene file to open, relative to the working directory and below folder; NULL: a room with a floor, a light and a
     * camera. */
    const char *scene;
    /* Folder that keeps the unsaved scene while it is unsaved (web/session/rescue.h), created when it is needed (with
     * confine at the start, and removed at the stop if it is empty); "": there is no such folder, which pages report;
     * NULL: nothing is kept or offered. */
    const char *rescue;
    const char *results; /* folder for the rows of studies: folder itself or below it; it need not exist */
    int port;            /* 0: any free port */
    isa level;
    int threads;           /* default of render.threads for opened scenes; 0: keep the scene's value */
    double requests_per_s; /* 0: the default of web/http/http.h */
    /* The laboratory's threads, and programs that they start, give up all other access to files: in addition to its own
     * checks, and where the kernel has Landlock. The caller's threads keep theirs. */
    bool confine;
} lab_settings;

status lab_start(const lab_settings *settings, lab **out, diagnostic *why);
void lab_stop(lab *l); /* NULL is allowed */
/* An unsaved scene stays on disk at the stop, to be offered by the next laboratory; otherwise a stop removes it. */
void lab_leave_unsaved(lab *l);

/* "http://127.0.0.1:PORT/?token=TOKEN" */
const char *lab_address(const lab *l);
/* The HTTP server, for its port and token. */
const struct http_server *lab_server(const lab *l);
