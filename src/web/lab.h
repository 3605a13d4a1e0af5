/* The laboratory in a browser: one scene on a desk, a painter who renders it whenever it changes, a toy that moves,
 * studies that run; served to pages and programs through web/http/http.h, by the API of web/README.md. Ownership:
 * lab_start gives, lab_stop releases and joins all threads; the settings' texts are borrowed in between. Errors:
 * STATUS_BAD_INPUT for a scene, folder or port that cannot be had, STATUS_FAILURE for memory and threads. Nothing is
 * printed, no signal is taken. */
#pragma once

#include "base/isa.h"
#include "scene/model/open.h"

typedef struct lab lab;

typedef struct lab_settings {
    const char *folder;  /* nothing outside of it is read or written */
    const char *scene;   /* file to open, in the working folder's terms and below folder; NULL: a room with a floor, a
                            light and a camera */
    const char *results; /* folder of studies' rows: folder, or below it; it need not be there */
    int port;            /* 0: any that is free */
    isa level;
    int threads;           /* of scenes as they are opened; 0: what they say */
    double requests_per_s; /* 0: as web/http/http.h has it */
} lab_settings;

status lab_start(const lab_settings *settings, lab **out, diagnostic *why);
void lab_stop(lab *l); /* NULL is allowed */

/* "http://127.0.0.1:PORT/?token=TOKEN" */
const char *lab_address(const lab *l);
/* Who serves it: its port and token by themselves. */
const struct http_server *lab_server(const lab *l);
