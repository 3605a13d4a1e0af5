/* Whether an animation fits on its file system. */
#include "cli/animate.h"
#include "base/budget.h"
#include "cli/terminal.h"
#include "image/image.h"
#include "image/video.h"
#include "scene/model/scene.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Frames that do not exist yet; those that --restart removes make room for the new ones. */
static double count_missing(const animate_names *names, int64_t count)
{
    double missing = 0;
    for (int64_t k = 0; k < count; k++) {
        char *path = animate_name(names, k);
        missing += path && access(path, F_OK) != 0;
        free(path);
    }
    return missing;
}

static void add_stream(const animate_request *request, double width, double height, double frames, disk_room *to)
{
    const double chroma = ceil(width / 2) * ceil(height / 2), frame = width * height + 2 * chroma + 6; /* 4:2:0 */
    if (video_format_of(request->output) == VIDEO_APNG)
        image_room(IMAGE_PNG, width, height, frames, to);
    else
        disk_room_add(to, 1, frames * frame, frames * frame + 100);
}

static bool is_device(const char *path)
{
    struct stat about;
    return strcmp(path, "-") == 0 || (stat(path, &about) == 0 && !S_ISREG(about.st_mode));
}

status animate_check_room(const animate_request *request, const animate_names *names, const scene *s, diagnostic *why)
{
    enum { ROW_MOST = 600 };
    disk_room needed = {0};
    char note[DISK_ROOM_TEXT_MAX];
    const int64_t count = frame_times_count(&request->times);
    const double width = (double)s->render.width, height = (double)s->render.height;
    if (!names && is_device(request->output))
        return STATUS_OK;
    if (names)
        image_room(image_format_of(request->output), width, height, count_missing(names, count), &needed);
    else
        add_stream(request, width, height, (double)count, &needed);
    if (request->rows)
        disk_room_add(&needed, 1, 0, ROW_MOST * (double)count);
    const char *place = names ? names->folder : request->output;
    TRY(disk_room_check(&needed, disk_room_free(place), place, "the animation", note, why));
    if (note[0] && !request->json)
        terminal_note(note);
    return STATUS_OK;
}
