/* The child process cuvette-import, which reads a mesh file: started with pipes, read until a deadline, always reaped.
 * Private to the mesh reader; other code uses scene/assets/mesh_file.h. Ownership: every open needs a close; all
 * descriptors are close-on-exec. The caller's signal handlers and other children are not affected. */
#pragma once

#include "scene/assets/mesh_stream.h"
#include <sys/types.h>

typedef struct mesh_child {
    pid_t pid;
    int handle;        /* pidfd, which cannot be reused as a process id can; -1 if the kernel has no pidfds */
    int out, err;      /* read ends of its standard output and error; -1 after their end */
    double deadline_s; /* on the monotonic clock */
    char said[2048];   /* the beginning of its standard error */
    size_t said_length;
    bool late;      /* killed after the deadline */
    bool cancelled; /* killed because the work was (base/cancel.h) */
    int error;      /* errno of a failed read of its output */
} mesh_child;

/* The path of cuvette-import, the first that exists: $CUVETTE_IMPORT (only this one if it is set); the folder of the
 * running program; ../libexec/cuvette relative to it, where `make install` puts it; the same folder of the installation
 * prefix. Free it; NULL if memory runs out. */
char *mesh_child_program(void);

/* Starts the importer on path. STATUS_BAD_INPUT if it is not installed, STATUS_FAILURE if it cannot be started. */
status mesh_child_open(mesh_child *child, const char *path, const mesh_limits *limits, diagnostic *why);

/* The monotonic clock. */
double mesh_child_now_s(void);

/* For a mesh_source whose context is the child. At the end of the stream the diagnostic is left to mesh_child_close. */
status mesh_child_read(void *context, void *bytes, size_t size, diagnostic *why);
status mesh_child_end(void *context, diagnostic *why);

/* Terminates the child and waits for it. code is the result of reading: STATUS_OK is kept only if the child exited
 * successfully; the child's own message, or its signal, takes precedence over the reader's. */
status mesh_child_close(mesh_child *child, const char *path, const mesh_limits *limits, status code, diagnostic *why);
