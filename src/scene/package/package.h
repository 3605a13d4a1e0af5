/* A package: a loaded scene as one sequence of bytes, so that one process reads the files, moves the slimes and builds
 * the hierarchies, and others get everything without reading a file. It contains the scene's parameters (as the text of
 * scene/file/write.h, whose numbers are exact), path and limits, and all loaded data: the sky, textures, meshes with
 * their hierarchies, the materials in mesh files, and the quantities of slimes. The unpacked scene has the same film,
 * counters and mesh report, and its frames build no hierarchy that is in the package.
 *
 * A package is for processes of the same build (base/installed.h): another build refuses it. It is in native byte order
 * and is not a file format. The receiver trusts nothing: sizes, indices and numbers are checked, and a hash at the end
 * covers all bytes, against errors and not against an adversary.
 *
 * Ownership: the scene is borrowed; the caller releases scene_pack's bytes with free, and an unpacked scene with
 * scene_destroy. Errors: STATUS_BAD_INPUT for a scene that no text describes (arrays and pixels given by a program,
 * names that are not UTF-8), and for a package that is damaged, ends early, or comes from another build; STATUS_FAILURE
 * if memory runs out; or the status of a stream's function. */
#pragma once

#include "base/pack.h"
#include "scene/model/open.h"

/* Builds the hierarchies that frames of a loaded scene use and keep: by render.accel, for all meshes that a visible
 * solid shows. Does nothing for render.keep=off (every frame builds its own) and for the depth buffer. Call it before
 * packing: a package contains all hierarchies that the meshes have. */
status scene_build_hierarchies(const scene *s, diagnostic *why);

/* Pack and unpack in memory. No other thread may change the scene meanwhile. */
status scene_pack(const scene *s, void **bytes, size_t *size, diagnostic *why);
status scene_unpack(const void *bytes, size_t size, scene **out, diagnostic *why);

/* Pack and unpack through functions, without a copy of the package: arrays are passed directly from the scene, and read
 * into their final place. read is called with the same sizes as write, in the same order. Most calls are short, so a
 * sender should collect them. */
status scene_pack_to(const scene *s, pack_write *write, void *context, diagnostic *why);
status scene_unpack_from(pack_read *read, void *context, scene **out, diagnostic *why);

/* --- package_scene.c, for package.c: the contents of a package, without its head and its hash --- */

/* text: the scene as scene_write_text writes it. */
status package_put_scene(pack_writer *to, const scene *s, const char *text, diagnostic *why);
status package_get_scene(pack_reader *from, scene **out, diagnostic *why);
