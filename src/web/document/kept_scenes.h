/* Unsaved scenes on disk: one file per laboratory, in a folder that laboratories share. A file is locked (flock) by the
 * laboratory that writes it or offers it, so a file that can be locked has no owner: its laboratory died. A file is the
 * scene's text after a first line, a comment with its time, title, folder and file. Ownership: kept_scenes_claim and
 * kept_scene_write fill a kept_scene, kept_scene_remove and kept_scene_release empty it. Not thread-safe. */
#pragma once

#include "base/status.h"

#include <jansson.h>
#include <stddef.h>

/* KEPT_SCENES_MAX: how many scenes without an owner are kept, the newest. KEPT_SCENE_BYTES_MAX: limit of a file. */
enum { KEPT_SCENES_MAX = 8, KEPT_SCENE_BYTES_MAX = 4 << 20 };

/* All zero: no scene. */
typedef struct kept_scene {
    char *path;
    char id[20];
    int fd;        /* holds the lock */
    json_t *about; /* {"time": "2026-11-26T03:47:38Z", "title", "folder", "file": NAME in it or null} */
} kept_scene;

/* Locks the scenes without an owner, newest first, and removes those beyond KEPT_SCENES_MAX and unfinished files.
 * Ignores files that cannot be read or locked. Returns the number of scenes. */
size_t kept_scenes_claim(const char *folder, kept_scene list[KEPT_SCENES_MAX]);

/* Creates the folder with mode 0700. STATUS_FAILURE if it belongs to another user, or another user can write to it. */
status kept_scenes_folder(const char *folder, diagnostic *why);
/* Writes a scene to a new file, or replaces the file of *kept; creates the folder. about: title, folder and file; the
 * time is added. *kept is unchanged after an error. */
status kept_scene_write(const char *folder, kept_scene *kept, json_t *about, const char *text, diagnostic *why);
/* Reads the file's text, which the caller frees. */
status kept_scene_read(const kept_scene *k, char **text, size_t *size, diagnostic *why);

void kept_scene_remove(kept_scene *k);  /* deletes the file */
void kept_scene_release(kept_scene *k); /* the file stays, without an owner */
