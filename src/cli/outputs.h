/* Output files: the image of a render, its per-pixel maps, timeline and layers, and text outputs. Names are checked
 * before anything is rendered, so that an hour of work is not lost to a misspelt ending. Ownership: names are
 * borrowed. */
#pragma once

#include "job/job.h"
#include "render/frame/record.h"

#include <stdio.h>

typedef struct outputs {
    const char *img, *rays, *time, *cut, *noise, *timeline, *layers; /* NULL: none; layers: a prefix */
    int bits;      /* bits per channel of a PNG: 8, 16; 0: not given */
    bool stokes;   /* Stokes vectors in the OpenEXR image */
    int64_t bands; /* bands of wavelengths in the OpenEXR image; 0: none */
} outputs;

/* The folder of a path, allocated; "." for a bare name. */
char *outputs_folder_of(const char *path);
bool outputs_same_entry(const char *a, const char *b);        /* both exist, and are one file or folder */
bool outputs_ends_with(const char *path, const char *ending); /* ignores case */
bool outputs_is_page(const char *path);                       /* .html: cli/render.c writes it */

/* Calls `matches` with the path of each file that a scene reads, relative to the working folder, until it returns true;
 * returns whether it did. The files are the scene file, its background image, textures, meshes and scripts of slimes,
 * but not files that a mesh file refers to. */
bool scene_files_any(const scene *s, bool (*matches)(void *context, const char *path), void *context);

/* Checks endings and folders, and that no output equals another one or a file that the scene reads; but a map may have
 * the OpenEXR file of the image, and is then a channel of it. */
status outputs_check(const outputs *o, const scene *s, diagnostic *why);

/* The same for one image without a scene. option: the option that names the image. read: the `count` files that the
 * command reads. */
status outputs_check_image(const char *option, const char *path, const char *const *read, size_t count,
                           diagnostic *why);

/* Sets *which to the index of the ending that path has; reports an error with the remedy if it has none of them. */
status outputs_ending(const char *option, const char *path, const char *const *endings, size_t count,
                      const char *remedy, size_t *which, diagnostic *why);
/* Checks the folder only, for an output that may replace the input. "-" is always valid. */
status outputs_check_folder(const char *option, const char *path, diagnostic *why);
/* Checks the folder, and that the scene does not read the file. "-" is always valid. */
status outputs_check_place(const char *option, const char *path, const scene *s, diagnostic *why);
/* Checks that the file is no script of the scene, for an output that may replace the scene file. "-" is always
 * valid. */
status outputs_check_script(const char *option, const char *path, const scene *s, diagnostic *why);

/* Writes a text file atomically; path NULL or "-": writes to standard output. */
status outputs_write_text(const char *path, status (*write)(const void *content, FILE *out, diagnostic *why),
                          const void *content, diagnostic *why);

/* Writes all outputs for which result has data, except a page; an interrupted render may lack some. s: the scene, for
 * the metadata of a PNG or OpenEXR file. */
status outputs_write(const outputs *o, const scene *s, const render_result *result, const record_more *more,
                     diagnostic *why);

/* --- outputs_frames.c: channels of an OpenEXR image that need frames of their own --- */

enum { OUTPUTS_BANDS_MAX = 40 };

/* Channels S1.R to S3.B, the Stokes vectors with S0 = R, G, B; and S0.NUMBERnm, the spectral radiance of bands. The
 * struct must not move. */
typedef struct more_frames {
    record_more channels;
    char names[OUTPUTS_BANDS_MAX][24];
    float *values[3 + (OUTPUTS_BANDS_MAX + 2) / 3]; /* 3 a pixel */
    int value_count;
    image_text texts[3];
} more_frames;

/* Whether the scene has what o requests. */
status more_frames_check(const outputs *o, const scene *s, diagnostic *why);
/* Renders the frames: 3 for Stokes vectors, one for three bands each. Release *m whatever the status. */
status more_frames_render(const outputs *o, const scene *s, const film *whole, job *frame_job, more_frames *m,
                          diagnostic *why);
void more_frames_release(more_frames *m);
