/* The quick form of a study, for a look at all results within seconds: every frame is divided to at most
 * QUICK_PIXELS pixels, and every cell is measured once, without warm-up, in one process. Its times mean nothing; its
 * films and counts are as exact as any. Its runs carry `quick` in runs.json, and a results folder of a study has either
 * quick runs or others. Ownership: the study stays the caller's. */
#pragma once

#include "study/study.h"

enum { QUICK_PIXELS = 80 * 60 };

/* Divides width and height of the frame by the smallest whole number that leaves at most QUICK_PIXELS pixels. */
void quick_frame(scene *setting);

/* Gives the study its quick form. */
status study_make_quick(study *s, diagnostic *why);

/* Gives the study the form of its runs in the results folder. */
status study_follow_runs(study *s, const char *results, diagnostic *why);

/* STATUS_BAD_INPUT if the folder has runs of the other form. */
status quick_check_runs(const study *s, const char *folder, diagnostic *why);
