/* Reads the section lens_systems of a scene file, whose systems become solids (scene/lens/lens_prescription.h). Private
 * to this folder. */
#pragma once

#include "scene/data/document.h"
#include "scene/model/open.h"

/* Whether the scene's text may name lens files, and below which folder: not for texts that come without their file,
 * such as shared scenes. root: as in file_read_below; borrowed. */
typedef struct lens_access {
    bool allowed;
    const char *root;
} lens_access;

status read_lens_systems(const document *file, const lens_access *access, scene *s, const node *map, diagnostic *why);

/* scene_read_text with this access. */
status read_scene_text(const char *name, const char *text, size_t size, const lens_access *access, scene **out,
                       diagnostic *why);
