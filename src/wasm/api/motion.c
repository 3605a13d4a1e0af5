/* Slimes in motion for scripts: states and hands. */
#include "wasm/api/results.h"

#include "base/json_build.h"
#include "report/json.h"
#include "wasm/exports.h"
#include <math.h>

char *wasm_motion_names(const cuvette_motion *motion)
{
    json_t *list = json_array();
    for (size_t i = 0; i < cuvette_motion_count(motion); i++)
        json_add(&list, json_of_text(cuvette_motion_name(motion, i)));
    return results_text(list);
}

char *wasm_motion_state(const cuvette_motion *motion, const char *name)
{
    cuvette_slime s = {.size = sizeof s};
    if (results_note(cuvette_motion_state(motion, name, &s, &results_last)) != CUVETTE_OK)
        return NULL;
    json_t *json =
        json_pack("{s:o,s:I,s:I,s:I,s:I,s:o,s:o,s:o,s:o}", "time_s", json_of_real(s.time_s), "steps",
                  (json_int_t)s.steps, "substeps", (json_int_t)s.substeps, "masses", (json_int_t)s.masses, "held",
                  (json_int_t)s.held, "kinetic", json_of_real(s.kinetic), "elastic", json_of_real(s.elastic),
                  "compression", json_of_real(s.compression), "gravity", json_of_real(s.gravity));
    json_add_all(&json, json_pack("{s:o,s:o,s:o,s:o,s:o,s:o,s:o}", "center", results_vector(s.center), "momentum",
                                  results_vector(s.momentum), "volume", json_of_real(s.volume), "volume_at_rest",
                                  json_of_real(s.volume_at_rest), "low", json_of_real(s.low), "high",
                                  json_of_real(s.high), "speed_max", json_of_real(s.speed_max)));
    return results_text(json);
}

static cuvette_ray hand_ray(const double *n)
{
    return (cuvette_ray){.origin = {n[0], n[1], n[2]}, .direction = {n[3], n[4], n[5]}, .reach = n[6]};
}

char *wasm_motion_pick(const cuvette_motion *motion, const char *name, const double *ray)
{
    const cuvette_ray along = hand_ray(ray);
    double where[3] = {0, 0, 0}, distance;
    if (results_note(cuvette_motion_pick(motion, name, &along, where, &distance, &results_last)) != CUVETTE_OK)
        return NULL;
    return results_text(isfinite(distance)
                            ? json_pack("{s:o,s:o}", "distance", json_of_real(distance), "where", results_vector(where))
                            : json_null());
}

char *wasm_motion_grab(cuvette_motion *motion, const char *name, const double *ray, double reach)
{
    const cuvette_ray along = hand_ray(ray);
    double where[3] = {0, 0, 0};
    int hand = CUVETTE_NO_HAND;
    if (results_note(cuvette_motion_grab(motion, name, &along, reach, &hand, where, &results_last)) != CUVETTE_OK)
        return NULL;
    return results_text(hand == CUVETTE_NO_HAND ? json_null()
                                                : json_pack("{s:i,s:o}", "hand", hand, "where", results_vector(where)));
}
