/* The linter's parts; for src/lint alone. Each looks at a plan and gives its notes. */
#pragma once

#include "render/core/plan.h"
#include "scene/model/inert/note.h"
#include "scene/model/scene.h"

typedef struct lint_room {
    const scene *of; /* what is looked at, as the caller has it */
    plan *made;      /* of a copy with a small image; its depth may be turned */
    isa level;
    const note_taker *taker;
} lint_room;

/* Solids of equal priority that overlap, and narrow gaps. */
status lint_neighbours(const lint_room *room, diagnostic *why);

/* A camera where nothing is seen: in an opaque solid, under the ground, in the wall of a cup. */
void lint_camera(const lint_room *room);

/* A depth limit that shows. */
status lint_depth(const lint_room *room, diagnostic *why);

/* The solid of a rank's body. */
static inline const solid *lint_solid(const lint_room *room, int priority_index)
{
    return &room->of->solids[room->made->geometry->regions[priority_index].solid];
}
