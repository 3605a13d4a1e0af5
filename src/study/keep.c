#include "study/keep.h"
#include "base/file.h"
#include "base/text.h"
#include "render/record.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef enum kept {
    KEPT_PNG,
    KEPT_PFM,
    KEPT_RAYS_PNG,
    KEPT_RAYS_PFM,
    KEPT_NS_PNG,
    KEPT_NS_PFM,
    KEPT_TIMELINE,
    KEPT_COUNT
} kept;

static bool wanted(const study *s, kept what)
{
    switch (what) {
    case KEPT_PNG: return s->keep_image;
    case KEPT_PFM: return s->keep_pfm;
    case KEPT_RAYS_PNG:
    case KEPT_RAYS_PFM: return s->keep_pixel_rays;
    case KEPT_NS_PNG:
    case KEPT_NS_PFM: return s->keep_pixel_time;
    case KEPT_TIMELINE: return s->keep_timeline;
    case KEPT_COUNT: break;
    }
    return false;
}

static char *kept_path(const char *folder, size_t cell, kept what)
{
    static const char *const endings[KEPT_COUNT] = {".png",    ".pfm",    "-rays.png",     "-rays.pfm",
                                                    "-ns.png", "-ns.pfm", "-timeline.json"};
    return text_format("%s/images/%04zu%s", folder, cell, endings[what]);
}

bool keep_missing(const study *s, const char *folder, size_t cell)
{
    for (kept what = 0; what < KEPT_COUNT; what++) {
        char *path = wanted(s, what) ? kept_path(folder, cell, what) : NULL;
        bool missing = path && access(path, F_OK) != 0;
        free(path);
        if (missing)
            return true;
    }
    return false;
}

render_options keep_options(const study *s)
{
    return (render_options){
        .pixel_rays = s->keep_pixel_rays, .pixel_time = s->keep_pixel_time, .timeline = s->keep_timeline};
}

static status write_kept(const render_result *frame, kept what, const char *path, diagnostic *why)
{
    switch (what) {
    case KEPT_PNG:
    case KEPT_PFM: return record_picture(frame->picture, path, 8, why);
    case KEPT_RAYS_PNG:
    case KEPT_RAYS_PFM: return record_map(frame->pixel_rays, frame->picture, "rays per pixel", path, why);
    case KEPT_NS_PNG:
    case KEPT_NS_PFM: return record_map(frame->pixel_ns, frame->picture, "nanoseconds per pixel", path, why);
    case KEPT_TIMELINE: return record_timeline(frame, path, why);
    case KEPT_COUNT: break;
    }
    return STATUS_OK;
}

status keep_write(const study *s, const char *folder, size_t cell, const render_result *frame, diagnostic *why)
{
    char *images = text_format("%s/images", folder);
    status code = images ? file_make_directory(images, why) : diagnose(why, STATUS_FAILURE, "", "out of memory");
    free(images);
    for (kept what = 0; code == STATUS_OK && what < KEPT_COUNT; what++) {
        if (!wanted(s, what))
            continue;
        char *path = kept_path(folder, cell, what);
        code = path ? write_kept(frame, what, path, why) : diagnose(why, STATUS_FAILURE, "", "out of memory");
        free(path);
    }
    return code;
}
