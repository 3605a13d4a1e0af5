/* Internals of a study, shared by study.c (cells, running) and study_results.c (what the rows say). */
#pragma once

#include "study/study.h"

struct cuvette_study {
    study *of;
};

/* The results folder: "results" for NULL. */
const char *engine_results(const char *results);
