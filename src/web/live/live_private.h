/* The live slime, shared by live.c (what other threads ask), live_snapshot.c (which scene it is in, and orders) and
 * live_move.c (its motion). */
#pragma once

#include "scene/motion/motion_hands.h"
#include "web/live/live.h"
#include <pthread.h>

typedef enum live_mode { LIVE_IS_OFF, LIVE_IS_PAUSED, LIVE_IS_PLAYING } live_mode;

/* A grab that waits; on the stack of who asks. */
typedef struct grab_request {
    vec3 origin, direction;
    double reach;
    int hand;
    vec3 where;
    status code;
    diagnostic *why;
    bool done;
    struct grab_request *next;
} grab_request;

enum { LIVE_HANDS_MAX = 256 };

/* One of those that others know, by a number that is never given again. */
typedef struct live_hand {
    int id; /* 0: none */
    size_t slime;
    int number; /* of the body's own */
    vec3 where; /* in the world */
    vec3 by;    /* of the world: where it is to be, from there */
    bool let_go;
} live_hand;

/* What is told of it. */
typedef struct live_account {
    bool has_slime, resting, in_trouble;
    double time_s, speed, volume, volume_at_rest, realtime;
    size_t held;
    diagnostic trouble;
} live_account;

struct live {
    void (*wake)(void *context);
    void *context;

    /* of all from here to the painter's own; grabs are done under it, which takes a millisecond */
    pthread_mutex_t lock;
    pthread_cond_t answered;
    live_mode mode;
    live_preview preview;
    bool restart, ordered, stopped;
    grab_request *first;
    live_hand held[LIVE_HANDS_MAX];
    int last_id;
    live_account account;

    /* The painter's own. */
    scene *snapshot;      /* NULL: none now */
    scene_motion *motion; /* NULL: not begun */
    motion_hand *hands;   /* SOFTBODY_HANDS_MAX of each slime */
    double time_s;
    double moved_at_s; /* wall time of the latest move; NaN: it stood still */
    double cost;       /* computing time of a second of motion; 0: not known */
    double realtime;
    double quiet_s;      /* how long it has been at rest */
    bool moved, changed; /* the stage looks otherwise; what is told is other than by mere motion */
};

/* --- live_move.c --- */

/* Moves by the wall time since the last call, at most about most_s of work. The lock is not held. STATUS_BAD_INPUT: the
 * body blew up. */
status live_move_on(live *l, double most_s, diagnostic *why);
/* Nothing is left of how it moved. */
void live_stand_still(live *l);
