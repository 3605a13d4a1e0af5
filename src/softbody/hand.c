/* Hands: scripts, the grip of hands on masses, and the playback of scripts. */
#include "base/array.h"
#include "softbody/softbody.h"
#include "softbody/softbody_private.h"
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* --- scripts --- */

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

static bool is_finite(vec3 v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

static status check_numbers(const char *hand, const hand_key *key, diagnostic *why)
{
    if (!(key->time_s >= 0.0 && isfinite(key->time_s)))
        return diagnose(why, STATUS_BAD_INPUT, "use a time of at least 0", "%s: invalid time %g s", hand, key->time_s);
    if (key->act == HAND_MOVE && !is_finite(key->by))
        return diagnose(why, STATUS_BAD_INPUT, "use three finite numbers", "%s: the displacement is not finite", hand);
    if (key->act != HAND_GRAB)
        return STATUS_OK;
    if (!is_finite(key->origin) || !is_finite(key->direction) || !(vec3_dot(key->direction, key->direction) > 0.0))
        return diagnose(why, STATUS_BAD_INPUT, "use finite coordinates and a non-zero direction",
                        "%s: the grab ray is not finite or has no direction", hand);
    if (!(key->reach > 0.0 && isfinite(key->reach)))
        return diagnose(why, STATUS_BAD_INPUT, "use a reach greater than 0", "%s: invalid reach %g", hand, key->reach);
    return STATUS_OK;
}

/* Checks that the key may follow the hand's last key. */
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
        return diagnose(why, STATUS_BAD_INPUT, "use a name of 1 to 63 bytes", "'%.80s' is not a valid name of a hand",
                        hand);
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
    return added; /* the caller counts it when it has a key */
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

/* --- grips --- */

int softbody_grab(softbody *b, vec3 where, double reach)
{
    int hand_number = 0;
    while (hand_number < SOFTBODY_HANDS_MAX && b->hands[hand_number].busy)
        hand_number++;
    if (hand_number == SOFTBODY_HANDS_MAX)
        return HAND_NONE;
    held_mass *masses = malloc(b->net.count * sizeof *masses);
    if (!masses)
        return HAND_NO_MEMORY;
    size_t count = 0, nearest = 0;
    double least = INFINITY;
    for (size_t i = 0; i < b->net.count; i++) {
        const vec3 away = vec3_sub(vectors_at(b->at, i), where);
        const double distance = vec3_length(away);
        if (b->inverse_mass[i] == 0.0)
            continue; /* grabbed by another hand */
        nearest = distance < least ? i : nearest;
        least = distance < least ? distance : least;
        if (distance <= reach)
            masses[count++] = (held_mass){(uint32_t)i, away};
    }
    if (count == 0 && least < INFINITY)
        masses[count++] = (held_mass){(uint32_t)nearest, vec3_sub(vectors_at(b->at, nearest), where)};
    if (count == 0) {
        free(masses);
        return HAND_NONE;
    }
    for (size_t i = 0; i < count; i++)
        b->inverse_mass[masses[i].mass] = 0.0;
    b->hands[hand_number] = (grip){.busy = true, .at = where, .target = where, .masses = masses, .count = count};
    b->has_acceleration = false;
    return hand_number;
}

void softbody_hold(softbody *b, int hand, vec3 target)
{
    if (hand >= 0 && hand < SOFTBODY_HANDS_MAX && b->hands[hand].busy)
        b->hands[hand].target = target;
}

void softbody_release(softbody *b, int hand)
{
    if (hand < 0 || hand >= SOFTBODY_HANDS_MAX || !b->hands[hand].busy)
        return;
    grip *h = &b->hands[hand];
    for (size_t i = 0; i < h->count; i++)
        b->inverse_mass[h->masses[i].mass] = 1.0 / b->mass_kg[h->masses[i].mass];
    free(h->masses);
    *h = (grip){0};
    b->has_acceleration = false;
}

void softbody_aim_hands(softbody *b, double dt_s)
{
    for (int i = 0; i < SOFTBODY_HANDS_MAX; i++) {
        const grip *h = &b->hands[i];
        for (size_t k = 0; h->busy && k < h->count; k++) {
            const uint32_t mass = h->masses[k].mass;
            const vec3 displacement = vec3_sub(vec3_add(h->target, h->masses[k].offset), vectors_at(b->at, mass));
            vectors_put(b->velocity, mass, vec3_scale(displacement, 1.0 / dt_s));
        }
    }
}

void softbody_move_hands(softbody *b)
{
    for (int i = 0; i < SOFTBODY_HANDS_MAX; i++)
        b->hands[i].at = b->hands[i].target;
}

status softbody_follow(softbody *b, const hand_script *script, diagnostic *why)
{
    for (size_t i = 0; b->plays && i < b->script->track_count; i++)
        softbody_release(b, b->plays[i].hand);
    free(b->plays);
    b->script = script;
    b->plays = script ? calloc(script->track_count + 1, sizeof *b->plays) : NULL;
    if (script && !b->plays)
        return diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory for a script");
    for (size_t i = 0; b->plays && i < script->track_count; i++)
        b->plays[i].hand = HAND_NONE;
    return STATUS_OK;
}

/* The step nearest to a time; times too far away are never reached. */
static uint64_t step_of(const softbody *b, double time_s)
{
    return (uint64_t)fmin(floor(time_s / b->set.dt_s + 0.5), 0x1p62);
}

static status start_grab(softbody *b, const hand_track *track, const hand_key *key, track_play *play, diagnostic *why)
{
    vec3 where;
    if (!softbody_pick(b, key->origin, key->direction, &where)) {
        diagnostic_locate(why, b->script->path, key->line, key->column);
        return diagnose(why, STATUS_BAD_INPUT, "aim the ray at the position of the slime at that time",
                        "the hand %.80s grabs nothing at %g s: its ray misses the slime", track->name, key->time_s);
    }
    play->hand = softbody_grab(b, where, key->reach);
    if (play->hand == HAND_NO_MEMORY)
        return diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory for a hand");
    if (play->hand == HAND_NONE) {
        diagnostic_locate(why, b->script->path, key->line, key->column);
        return diagnose(why, STATUS_BAD_INPUT, "release the other hands first, or reduce their reach",
                        "the hand %.80s grabs nothing at %g s: other hands hold all masses", track->name, key->time_s);
    }
    play->where = where;
    play->from = vec3_make(0.0, 0.0, 0.0);
    play->from_step = b->steps;
    return STATUS_OK;
}

/* Executes a key that is due. */
static status act(softbody *b, const hand_track *track, const hand_key *key, track_play *play, diagnostic *why)
{
    switch (key->act) {
    case HAND_GRAB: return start_grab(b, track, key, play, why);
    case HAND_MOVE:
        play->from = key->by;
        play->from_step = b->steps;
        break;
    case HAND_RELEASE:
        softbody_release(b, play->hand);
        play->hand = HAND_NONE;
        break;
    }
    return STATUS_OK;
}

/* The displacement of a hand at the end of the current step: interpolated towards the next move, otherwise
 * unchanged. */
static vec3 offset_after(const softbody *b, const hand_track *track, const track_play *play)
{
    if (play->next == track->key_count || track->keys[play->next].act != HAND_MOVE)
        return play->from;
    const hand_key *to = &track->keys[play->next];
    const uint64_t end = step_of(b, to->time_s);
    const double fraction = (double)(b->steps + 1 - play->from_step) / (double)(end - play->from_step);
    return fraction >= 1.0 ? to->by : vec3_add(play->from, vec3_scale(vec3_sub(to->by, play->from), fraction));
}

status softbody_play(softbody *b, diagnostic *why)
{
    status code = STATUS_OK;
    for (size_t i = 0; b->plays && i < b->script->track_count && code == STATUS_OK; i++) {
        const hand_track *track = &b->script->tracks[i];
        track_play *play = &b->plays[i];
        for (; code == STATUS_OK && play->next < track->key_count &&
               step_of(b, track->keys[play->next].time_s) <= b->steps;
             play->next++)
            code = act(b, track, &track->keys[play->next], play, why);
        if (code == STATUS_OK && play->hand >= 0)
            softbody_hold(b, play->hand, vec3_add(play->where, offset_after(b, track, play)));
    }
    return code;
}
