/* A recorded hand: what is taken hold of, where it is moved to, when it is let go; so that a grab can be made again, to
 * the bit. A script holds a track for each hand. Ownership: hand_script_create gives an empty one, hand_script_add
 * grows it, hand_script_destroy releases. Times of a track never fall; between a grab and a release the hand moves in
 * straight lines from key to key. */
#pragma once

#include "base/status.h"
#include "base/vec3.h"
#include <stddef.h>

typedef enum hand_act { HAND_GRAB, HAND_MOVE, HAND_RELEASE } hand_act;

typedef struct hand_key {
    double time_s;
    hand_act act;
    vec3 origin, direction; /* of a grab: the ray under which it takes hold, in the frame of the body's mesh */
    double reach;           /* of a grab: all masses so near to where the ray meets the skin; scene units */
    vec3 by;                /* of a move: how far from where it took hold the hand is at time_s */
    long line, column;      /* in its file */
} hand_key;

enum { HAND_NAME_MAX = 63 };
typedef struct hand_track {
    char name[HAND_NAME_MAX + 1];
    hand_key *keys;
    size_t key_count;
} hand_track;

typedef struct hand_script {
    char *path; /* of its file; "" for none */
    hand_track *tracks;
    size_t track_count;
} hand_script;

/* NULL when memory is out. path is copied. */
hand_script *hand_script_create(const char *path);
void hand_script_destroy(hand_script *s); /* NULL is allowed */

/* One more key at the end of the hand's track, which begins with its first. STATUS_BAD_INPUT: more hands than
 * SOFTBODY_HANDS_MAX, a time before the key in front of it, a move or a release of a hand that holds nothing, a grab of
 * one that holds something; the script is then as it was. The diagnostic is not located. */
status hand_script_add(hand_script *s, const char *hand, const hand_key *key, diagnostic *why);

/* Time of the last key of all; 0 for none. */
double hand_script_end_s(const hand_script *s);
