/* Finished meshes as bytes (base/pack.h), with the hierarchies that they own, so that another process need not build
 * them. Of a hierarchy the triangles' numbers travel, and its blocks are filled from the mesh again: a tenth of the
 * bytes. What is read is checked: every index is in range,
 * every number finite, and every traversal ends. Ownership: an unpacked mesh is the caller's, mesh_release releases it.
 * Errors: STATUS_BAD_INPUT for damaged bytes, STATUS_FAILURE without memory. */
#pragma once

#include "base/pack.h"
#include "geometry/hierarchy.h"

/* While no other thread moves the mesh or builds one of its hierarchies. */
status mesh_pack(const mesh *m, pack_writer *to, diagnostic *why);
status mesh_unpack(pack_reader *from, const mesh **out, diagnostic *why);

/* A hierarchy of its mesh. */
status hierarchy_pack(const hierarchy *h, pack_writer *to, diagnostic *why);
status hierarchy_unpack(const mesh *m, pack_reader *from, hierarchy **out, hierarchy_kind *kind, diagnostic *why);
