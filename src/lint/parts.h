/* The parts of the linter, each of which examines a plan and reports notes. Private to src/lint. */
#pragma once

#include "lint/lint.h"
#include "render/plan/plan.h"
#include "scene/model/scene.h"

typedef struct lint_input {
    const scene *original; /* the caller's scene */
    plan *probe;           /* plan of a copy of the scene with a small image */
    isa level;
    const note_sink *taker;
} lint_input;

/* Notes overlapping solids of equal priority, and narrow gaps. */
status lint_neighbours(const lint_input *input, diagnostic *why);

/* Notes a depth limit or a minimum weight of ray trees that cuts much light, or may do so. rays: of all small images
 * together, at most. */
status lint_depth(const lint_input *input, double rays, diagnostic *why);

/* Notes a depth limit of random paths; the plan must be of the path integrator. */
status lint_path_depth(const lint_input *input, diagnostic *why);

/* The solid with the given priority index. */
static inline const solid *lint_solid(const lint_input *input, int priority_index)
{
    return &input->original->solids[input->probe->geometry->regions[priority_index].solid];
}
