/* What the driver of the fault injection (faults.c) and the library that it preloads (preload.c) tell each other: one
 * page of memory that both map, from the file that the environment variable FAULTS_PAGE names. */
#pragma once

#include <stdatomic.h>
#include <stdint.h>

enum { SITES_MAX = 32768, FRAMES_MAX = 40, MODULE_MAX = 96 };

/* What is counted and fails: allocations and threads in the program itself, by preload.c; system calls outside it, by
 * trace.c. */
typedef enum fault_class { FAULT_NONE, FAULT_MEMORY, FAULT_THREAD, FAULT_CALL } fault_class;

/* Where: in the process that was started, or in the children that it forks (which never call exec). */
typedef enum fault_place { FAULT_IN_PROGRAM, FAULT_IN_FORKED } fault_place;

typedef struct fault_site {
    uint64_t hash; /* of the call stack */
    uint32_t at;   /* the first call from there, counted from 1 */
} fault_site;

typedef struct fault_page {
    /* by the driver */
    char program[64]; /* the name of the process in which calls are counted */
    int class, place, records, stays;
    int depth;     /* frames of a stack that count, from the innermost; 0: all */
    long at;       /* this call fails, counted from 1; 0: none */
    uint64_t hash; /* or the first from this call stack; 0: none */
    /* by the library */
    _Atomic int owner;           /* the process; 0: not started yet */
    _Atomic long seen;           /* calls of the class */
    _Atomic int fired;           /* calls that failed */
    _Atomic long live;           /* allocated blocks */
    long live_at_end;            /* the same when the process ended by exit */
    int descriptors_at_end;      /* open descriptors then */
    int ended;                   /* 1: by exit */
    int frame_count;             /* of the call that failed */
    uint64_t frames[FRAMES_MAX]; /* addresses relative to their module */
    char modules[FRAMES_MAX][MODULE_MAX];
    uint64_t fired_hash;
    int site_count;
    fault_site sites[SITES_MAX];
} fault_page;

/* prctl(FAULTS_START) tells the tracer that the program itself begins. */
enum { FAULTS_START = 0x66617573 };
