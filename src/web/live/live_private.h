/* The private struct of the live slime, shared by live.c (requests of other threads) and live_simulation.c (its scene,
 * commands, hands and motion). */
#pragma once

#include "scene/motion/motion_hands.h"
#include "web/live/live.h"

#include <pthread.h>

typedef enum live_mode { LIVE_IS_OFF, LIVE_IS_PAUSED, LIVE_IS_PLAYING } live_mode;

/* A waiting grab; lives on the stack of the requesting thread. */
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

/* A hand as other threads know it, by a number that is never reused. */
typedef struct live_hand {
    int id; /* 0: none */
    size_t slime;
    int number; /* index in the body */
    vec3 where; /* grab point in world space */
    vec3 by;    /* world-space offset from the grab point to the target */
    bool released;
} live_hand;

/* The published summary of the simulation. */
typedef struct live_report {
    bool has_slime, resting, in_trouble;
    double time_s, speed, volume, volume_at_rest, realtime;
    size_t held_vertices;
    diagnostic trouble;
} live_report;

struct live {
    void (*wake)(void *context);
    void *context;

    /* guards the fields down to `report`; grabs run under it, about a millisecond */
    pthread_mutex_t lock;
    pthread_cond_t answered;
    live_mode mode;
    live_preview preview;
    bool restart, requested, stopped;
    grab_request *first;
    live_hand live_hands[LIVE_HANDS_MAX];
    int last_id;
    live_report report;

    /* Only the render worker uses these. */
    scene *snapshot;           /* NULL: detached */
    scene_motion *motion;      /* NULL: not started */
    motion_hand *motion_hands; /* SOFTBODY_HANDS_MAX of each slime */
    double time_s;
    double moved_at_s; /* wall time of the latest step; NaN: no step since the start or a pause */
    double cost;       /* computation time per second of motion; 0: unknown */
    double realtime;
    double quiet_s;      /* time without motion */
    bool moved, changed; /* the snapshot's appearance changed; the published state changed by more than the motion */
};
