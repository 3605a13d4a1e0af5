/* A loaded scene as one sequence of bytes, so that one process reads the files, moves the slimes and builds the
 * hierarchies, and others get everything without reading a file: a package. It holds the scene's parameters (as the
 * text of scene/file/write.h, whose numbers are exact), path and limits, and what is loaded: the sky, textures, meshes
 * with their hierarchies, the materials in mesh files, and the accounts of slimes. The scene that is unpacked gives the
 * same film, counters and mesh report, and its frames build no hierarchy that the package holds.
 *
 * A package is for processes of the same build (base/build_id.h): another build refuses it. It is in native byte order
 * and is not a file format. The receiver trusts nothing: sizes, indices and numbers are checked, and a hash at the end
 * covers all bytes, against errors and not against an adversary.
 *
 * Ownership: the scene is borrowed; scene_pack's bytes are the caller's, released with free; so is the scene that is
 * unpacked, released with scene_destroy. Errors: STATUS_BAD_INPUT for a scene that no text describes (arrays and pixels
 * given by a program, names that are not UTF-8), and for a package that is damaged, ends early, or is another build's;
 * STATUS_FAILURE without memory; or the status of a stream's function. */
#pragma once

#include "base/pack.h"
#include "scene/model/open.h"

/* Builds the hierarchies that frames of a loaded scene use and keep: those of render.accel for all meshes that a
 * visible solid shows. None under render.keep=off, where every frame builds its own, and for integrators that trace no
 * rays. To be called before packing; a package holds all hierarchies that the meshes have. */
status scene_build_hierarchies(const scene *s, diagnostic *why);

/* While no other thread changes the scene. The peak of memory is the scene's and the package's. */
status scene_pack(const scene *s, void **bytes, size_t *size, diagnostic *why);
status scene_unpack(const void *bytes, size_t size, scene **out, diagnostic *why);

/* The same through functions, without a copy of the whole: arrays are passed as they lie in the scene, and read into
 * their final place. read is called with the sizes of the calls of write, in the same order, unless an error ends it.
 * Most calls are short, so that a sender collects them. */
status scene_pack_to(const scene *s, pack_write *write, void *context, diagnostic *why);
status scene_unpack_from(pack_read *read, void *context, scene **out, diagnostic *why);
