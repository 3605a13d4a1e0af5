/* One run of a program with a fault. */
#pragma once

#include "page.h"

#include <stdbool.h>

/* The system calls that fail, by group; a group counts the calls of several names. */
typedef enum call_group {
    CALL_MMAP,
    CALL_OPEN,
    CALL_READ,
    CALL_WRITE,
    CALL_SYNC,
    CALL_RENAME,
    CALL_CLOSE,
    CALL_GROUPS
} call_group;

enum { FAULT_SHORT = -1 }; /* in place of an errno: the call transfers half of the bytes */

typedef struct fault {
    fault_class class;
    fault_place place;
    bool records, stays; /* stays: every later call fails as well */
    long at;
    uint64_t hash;
    int depth;        /* frames of a stack that count; 0: all */
    call_group group; /* FAULT_CALL */
    int error;
} fault;

typedef struct run {
    char *folder;          /* where it runs */
    char *const *words;    /* the command */
    const char *target;    /* the name of the process in which calls fail */
    const char *out, *err; /* paths for its output */
    const char *library;   /* the one to preload */
    int limit_s;
} run;

typedef struct outcome {
    int code; /* exit status; 128 + number of the signal that ended it */
    bool timed_out;
    long counted;               /* calls of the group, FAULT_CALL; otherwise see the page */
    long by_group[CALL_GROUPS]; /* of every group, FAULT_CALL */
    bool fired;
    bool must_report; /* fsync of a file failed: the user must learn of it */
} outcome;

/* Maps the page; path: a file that this creates. */
void run_prepare(const char *path);
extern fault_page *run_page;

outcome run_with(const run *r, const fault *f);
