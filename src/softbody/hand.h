/* Recorded hands: what is grabbed, where it is moved, when it is released; playback is bit-identical. A script has a
 * track for each hand. Ownership: hand_script_create gives an empty one, hand_script_add appends, hand_script_destroy
 * releases. Times of a track do not decrease; between a grab and a release the hand moves linearly from key to key. */
#pragma once

#include "base/status.h"
#include "base/vec3.h"
#include <stddef.h>

typedef enum hand_act { HAND_GRAB, HAND_MOVE, HAND_RELEASE } hand_act;

typedef struct hand_key {
    double time_s;
    hand_act act;
    vec3 origin, direction; /* of a grab: the grab ray in the frame of the body's mesh */
    double reach;           /* of a grab: radius around the hit of the ray with the surface; scene units */
    vec3 by;                /* of a move: displacement from the point of the grab at time_s */
    long line, column;      /* location in its file */
} hand_key;

enum { HAND_NAME_MAX = 63 };
typedef struct hand_track {
    char name[HAND_NAME_MAX + 1];
    hand_key *keys;
    size_t key_count;
} hand_track;

typedef struct hand_script {
    char *path; /* path of its file; "" for none */
    hand_track *tracks;
    size_t track_count;
} hand_script;

/* NULL if memory runs out. path is copied. */
hand_script *hand_script_create(const char *path);
void hand_script_destroy(hand_script *s); /* NULL is allowed */

/* Appends a key to the hand's track, which is created with its first key. STATUS_BAD_INPUT: more hands than
 * SOFTBODY_HANDS_MAX, a time before the previous key, a move or release of a hand without a grab, a grab of a hand that
 * already holds something; the script is then unchanged. The diagnostic is not located. */
status hand_script_add(hand_script *s, const char *hand, const hand_key *key, diagnostic *why);

/* Time of the last key of all; 0 for none. */
double hand_script_end_s(const hand_script *s);
