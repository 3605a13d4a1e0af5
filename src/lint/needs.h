/* What a parameter needs to have an effect: a table of conditions, each on another parameter or on a fact of the scene.
 * The note of the first condition that does not hold follows from its row: "no effect with lamp.kind=point; set
 * lamp.kind=sun". Private to src/lint. */
#pragma once

#include "lint/inert_facts.h"

typedef struct needs_row {
    param_group group; /* of the parameters; rows of PARAM_MATERIAL apply to a solid's surface, too */
    const char *names; /* of the parameters, separated by spaces; "*": all of the group */
    /* "spectrum=black_body", "kind=cone|soft_cone", "kind!=sun", "intensity>0": of the same object, or with a full
     * path, of render, camera or background. A parameter does not need itself. NULL: the fact alone. */
    const char *needs;
    const char *remedy; /* what to set, % for the object's name; NULL: the first word after '=' */
    inert_rule *fact;   /* a condition that is code, and says the note */
    bool acts;          /* where the fact holds, the parameter has an effect: later rows do not count */
} needs_row;

/* Whether a row of the group says that c's parameter has no effect. */
bool needs_ask(const inert_case *c, param_group group);
/* The same of what integrators with layers, which trace no light, do not use. */
bool needs_light(const inert_case *c);
/* The table, for its test. */
const needs_row *needs_rows(size_t *count);
