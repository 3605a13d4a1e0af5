/* The parts of the linter; private to src/lint. Each examines a plan and passes its notes on. */
#pragma once

#include "lint/lint.h"
#include "render/plan/plan.h"
#include "scene/model/scene.h"

typedef struct lint_room {
    const scene *of; /* the caller's scene */
    plan *made;      /* plan of a copy with a small image, possibly with another depth */
    isa level;
    const note_taker *taker;
} lint_room;

/* Overlapping solids of equal priority, and narrow gaps. */
status lint_neighbours(const lint_room *room, diagnostic *why);

/* A depth limit of ray trees, or a least weight, with a visible effect, or with one that no image shows. */
status lint_depth(const lint_room *room, diagnostic *why);

/* The same of random paths; room->made is a plan of them. */
status lint_path_depth(const lint_room *room, diagnostic *why);

/* The solid with the given priority index. */
static inline const solid *lint_solid(const lint_room *room, int priority_index)
{
    return &room->of->solids[room->made->geometry->regions[priority_index].solid];
}
