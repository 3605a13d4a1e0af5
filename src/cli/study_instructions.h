/* `study run --instructions`: the study runs under valgrind, which counts the instructions of each frame
 * (measure/instruction_dumps.h). Ownership: counted_run is a value, which study_instructions_end ends, whatever begin
 * returned; a request that it has changed borrows from it. */
#pragma once

#include "cli/study_request.h"

typedef struct counted_run {
    char folder[200];   /* of the counts; "" without one */
    char results[4096]; /* DIR-instructions */
} counted_run;

/* Does nothing without --instructions. Otherwise the rows go to a folder of their own, and the environment of this
 * process and of those that it starts is that of counted rows: the instruction set is one that valgrind knows. */
status study_instructions_begin(study_request *request, counted_run *out, diagnostic *why);
void study_instructions_end(const counted_run *run);

/* The words that begin the command line of a counted process, before the program; returns their number, at most
 * STUDY_INSTRUCTIONS_WORDS. option: room for one of them. The program to start is /usr/bin/env. */
enum { STUDY_INSTRUCTIONS_WORDS = 8, STUDY_INSTRUCTIONS_OPTION = 300 };
size_t study_instructions_words(const char **words, char option[STUDY_INSTRUCTIONS_OPTION]);
