/* A study from texts that a manifest keeps, to learn what its rows meant. */
#ifndef CUVETTE_STUDY_RECORDED_H
#define CUVETTE_STUDY_RECORDED_H

#include "study/study.h"

/* The study of these texts in the place of `now`: its scene stands where that one's file does, so that the files it
 * names are looked for there. Nothing is opened, loaded or checked beyond what reading takes; fit for meaning_of_study
 * alone. */
status recorded_study(const study *now, const char *text, const char *scene_text, study **out, diagnostic *why);

#endif
