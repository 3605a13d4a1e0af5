/* The process that reads a mesh file in our stead, cuvette-import: started with a pipe, listened to until a deadline,
 * always reaped. Private to the mesh reader; scene/assets/mesh_file.h is for others. Ownership: the child's open and
 * close go together; every descriptor is closed on exec. No signal is sent to the caller, none of its signal handlers
 * is touched, other children are left alone. */
#pragma once

#include "scene/assets/mesh_stream.h"
#include <sys/types.h>

typedef struct mesh_child {
    pid_t pid;
    int handle;        /* of the process, whose number may come to stand for another; -1 where the kernel has none */
    int out, err;      /* our ends of its standard output and error; -1 when at their end */
    double deadline_s; /* of the monotonic clock */
    char said[2048];   /* the beginning of what it wrote on standard error */
    size_t said_length;
    bool late; /* stopped because the time was over */
} mesh_child;

/* The path of cuvette-import, the first that there is: $CUVETTE_IMPORT (only this one when it is set); the folder of
 * the running program; ../libexec/cuvette from there, where `make install` puts it; that folder of the installation.
 * Free it; NULL without memory. */
char *mesh_child_program(void);

/* Starts the importer on path. STATUS_BAD_INPUT when it is not installed, STATUS_FAILURE when the machine cannot. */
status mesh_child_open(mesh_child *child, const char *path, const mesh_limits *limits, diagnostic *why);

/* The monotonic clock. */
double mesh_child_now_s(void);

/* For a mesh_source whose context is the child. When it says no more, the diagnostic is left to mesh_child_close. */
status mesh_child_read(void *context, void *bytes, size_t size, diagnostic *why);
status mesh_child_end(void *context, diagnostic *why);

/* Ends the child, whatever it does, and waits for it. code is how the reading went: STATUS_OK stays only if the child
 * ended well; what the child said, or how it died, comes before what reading said. */
status mesh_child_close(mesh_child *child, const char *path, const mesh_limits *limits, status code, diagnostic *why);
