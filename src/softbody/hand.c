#include "softbody/hand.h"
#include "base/array.h"
#include "softbody/softbody.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

hand_script *hand_script_create(const char *path)
{
    hand_script *s = calloc(1, sizeof *s);
    char *copy = strdup(path);
    if (!s || !copy) {
        free(s);
        free(copy);
        return NULL;
    }
    s->path = copy;
    return s;
}

void hand_script_destroy(hand_script *s)
{
    if (!s)
        return;
    for (size_t i = 0; i < s->track_count; i++)
        free(s->tracks[i].keys);
    free(s->tracks);
    free(s->path);
    free(s);
}

static hand_track *find_track(const hand_script *s, const char *hand)
{
    for (size_t i = 0; i < s->track_count; i++)
        if (strcmp(s->tracks[i].name, hand) == 0)
            return &s->tracks[i];
    return NULL;
}

/* Also refuses NaN, for which every comparison is false. */
static bool is_point(vec3 v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

static status check_numbers(const char *hand, const hand_key *key, diagnostic *why)
{
    if (!(key->time_s >= 0.0 && isfinite(key->time_s)))
        return diagnose(why, STATUS_BAD_INPUT, "use a time of at least 0", "%s: invalid time %g s", hand, key->time_s);
    if (key->act == HAND_MOVE && !is_point(key->by))
        return diagnose(why, STATUS_BAD_INPUT, "use three finite numbers", "%s: the displacement is not finite", hand);
    if (key->act != HAND_GRAB)
        return STATUS_OK;
    if (!is_point(key->origin) || !is_point(key->direction) || !(vec3_dot(key->direction, key->direction) > 0.0))
        return diagnose(why, STATUS_BAD_INPUT, "give a non-zero direction",
                        "%s: the grab ray has a coordinate that is not finite", hand);
    if (!(key->reach > 0.0 && isfinite(key->reach)))
        return diagnose(why, STATUS_BAD_INPUT, "give a length greater than 0", "%s: a reach of %g", hand, key->reach);
    return STATUS_OK;
}

/* Whether the key is valid after the hand's last one. */
static status check_order(const char *hand, const hand_track *track, const hand_key *key, diagnostic *why)
{
    const hand_key *last = track && track->key_count ? &track->keys[track->key_count - 1] : NULL;
    const bool holds = last && last->act != HAND_RELEASE;
    if (last && key->time_s < last->time_s)
        return diagnose(why, STATUS_BAD_INPUT, "sort the entries of each hand by time", "%s: %g s comes after %g s",
                        hand, key->time_s, last->time_s);
    if (key->act == HAND_GRAB && holds)
        return diagnose(why, STATUS_BAD_INPUT, "release first, or use another hand for the second grab",
                        "%s: it already holds something", hand);
    if (key->act != HAND_GRAB && !holds)
        return diagnose(why, STATUS_BAD_INPUT, "add a grab before it", "%s: it cannot %s without a grab", hand,
                        key->act == HAND_MOVE ? "move" : "release");
    return STATUS_OK;
}

static status check_hand(const hand_script *s, const char *hand, const hand_track *track, diagnostic *why)
{
    if (!hand[0] || strlen(hand) > HAND_NAME_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use 1 to 63 bytes", "'%.80s' is not a valid name of a hand", hand);
    if (!track && s->track_count == SOFTBODY_HANDS_MAX)
        return diagnose(why, STATUS_BAD_INPUT,
                        "a script can have at most 16 hands; a hand can be reused after its release",
                        "too many hands: %s", hand);
    return STATUS_OK;
}

static hand_track *add_track(hand_script *s, const char *hand)
{
    if (!room_for_one(&s->tracks, s->track_count, sizeof *s->tracks))
        return NULL;
    hand_track *added = &s->tracks[s->track_count];
    *added = (hand_track){.keys = NULL};
    strcpy(added->name, hand);
    return added; /* counted only with a key */
}

status hand_script_add(hand_script *s, const char *hand, const hand_key *key, diagnostic *why)
{
    hand_track *track = find_track(s, hand);
    TRY(check_hand(s, hand, track, why));
    TRY(check_numbers(hand, key, why));
    TRY(check_order(hand, track, key, why));
    const bool is_new = !track;
    track = is_new ? add_track(s, hand) : track;
    if (!track || !room_for_one(&track->keys, track->key_count, sizeof *track->keys))
        return out_of_memory(why);
    track->keys[track->key_count++] = *key;
    s->track_count += is_new;
    return STATUS_OK;
}

double hand_script_end_s(const hand_script *s)
{
    double end_s = 0.0;
    for (size_t i = 0; i < s->track_count; i++) {
        const hand_track *track = &s->tracks[i];
        end_s = fmax(end_s, track->keys[track->key_count - 1].time_s);
    }
    return end_s;
}
