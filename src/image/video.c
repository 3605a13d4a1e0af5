/* Films in one file. */
#include "image/video.h"

#include "image/y4m.h"
#include <string.h>
#include <strings.h>

video_format video_format_of(const char *path)
{
    const char *ending = strrchr(path, '.');
    return ending && strcasecmp(ending, ".y4m") == 0    ? VIDEO_Y4M
           : ending && strcasecmp(ending, ".apng") == 0 ? VIDEO_APNG
                                                        : VIDEO_NONE;
}

status video_begin(video *v, video_format format, FILE *stream, int width, int height, int64_t frames, int64_t fps_num,
                   int64_t fps_den, diagnostic *why)
{
    *v = (video){.format = format,
                 .stream = stream,
                 .png = {.stream = stream, .frames = (uint32_t)frames, .fps_num = fps_num, .fps_den = fps_den}};
    return format == VIDEO_Y4M ? y4m_begin(stream, width, height, fps_num, fps_den, why) : STATUS_OK;
}

status video_frame(video *v, const image *img, diagnostic *why)
{
    return v->format == VIDEO_Y4M ? y4m_frame(v->stream, img, why) : apng_frame(&v->png, img, why);
}
