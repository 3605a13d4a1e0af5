/* The state of the rescue, shared by its two files: rescue.c writes the unsaved scene, rescue_offers.c has the scenes
 * that are offered. Private to them. */
#pragma once

#include "web/session/kept_scenes.h"
#include "web/session/rescue.h"

#include <pthread.h>

struct rescue {
    lab *l;
    const char *folder; /* "": none is known */
    pthread_t thread;
    bool started;
    kept_scene own;  /* of the thread */
    uint64_t number; /* of the version in own */

    pthread_mutex_t lock; /* guards the fields below */
    pthread_cond_t changed;
    bool woken, ending, failed;
    diagnostic trouble;
    /* Together never more than there were at first. opened: the document has them, but own may not have them yet. */
    kept_scene offers[KEPT_SCENES_MAX], opened[KEPT_SCENES_MAX];
    size_t offer_count, opened_count;
};

/* What the paths of files in a kept scene are relative to: its file, or its folder with any name. */
char *rescue_place(const char *root, const char *file);

/* Claims the scenes without an owner. */
void rescue_find_offers(rescue *r);
