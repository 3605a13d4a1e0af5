/* How the painter makes its pictures; see web/live/painter.h for those who look at them. */
#ifndef CUVETTE_WEB_LIVE_PICTURE_H
#define CUVETTE_WEB_LIVE_PICTURE_H

#include "web/live/painter.h"
#include <pthread.h>
#include <stdatomic.h>

typedef struct shared_picture shared_picture;

/* Frees what a picture that is not shared holds. */
void picture_drop(const picture *p);

/* One owner; takes what shown holds. NULL when memory is out: it is then the caller's still. */
const picture *picture_create(const picture *shown);

#endif
