/* Instructions of frames, counted by callgrind (valgrind), for machines with noisy clocks and no hardware counters: the
 * counts repeat within 0.03 % however busy the machine is. valgrind writes a dump whenever renderer_render returns,
 * with the counts since it was entered (INSTRUCTION_DUMPS_OPTIONS); these functions read and remove the dumps. `cuvette
 * study run --instructions` sets the variable. Plain values; nothing to release. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

/* The variable that has the path of the dumps, without their numbers. */
#define INSTRUCTION_DUMPS_VARIABLE "CUVETTE_CALLGRIND"
/* valgrind's options for the dumps, in addition to --callgrind-out-file=PATH. */
#define INSTRUCTION_DUMPS_OPTIONS "--tool=callgrind", "--zero-before=renderer_render", "--dump-after=renderer_render"

typedef struct instruction_dumps {
    long last; /* number of the last dump; start with 0 */
} instruction_dumps;

/* Whether the program runs under callgrind with such dumps. */
bool instruction_dumps_exist(void);

/* The instructions of the last frame, of all threads; -1 if there is no new dump. */
int64_t instruction_dumps_next(instruction_dumps *dumps);
