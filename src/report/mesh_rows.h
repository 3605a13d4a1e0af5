/* The description of a mesh as text and as JSON. Ownership: the JSON is a new reference, NULL when memory is out.
 * Errors of the stream stay in the stream, where the caller checks them. */
#pragma once

#include "geometry/mesh/mesh.h"
#include <jansson.h>
#include <stdio.h>

void mesh_rows_text(FILE *stream, const mesh *m);
json_t *mesh_rows_json(const mesh *m);
