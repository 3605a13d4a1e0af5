/* The settings of a laboratory: see web/lab.h. */
#pragma once

#include "base/isa.h"
#include "base/status.h"
#include <stdbool.h>

typedef struct lab lab;

typedef struct lab_settings {
    const char *folder; /* pages can read and write files only in it */
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
    /* Confine the laboratory's threads, and the programs that they start, to these folders and the system's files, in
     * addition to the laboratory's own checks, where the kernel has Landlock. The caller's threads are not confined. */
    bool confine;
} lab_settings;
