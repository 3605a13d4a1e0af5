/* What a mesh is, as a person and as a program read it. Ownership: the JSON is a new reference, NULL without memory.
 * Errors of the stream are left in the stream. */
#pragma once

#include "geometry/mesh.h"
#include <jansson.h>
#include <stdio.h>

void mesh_rows_text(FILE *stream, const mesh *m);
json_t *mesh_rows_json(const mesh *m);
