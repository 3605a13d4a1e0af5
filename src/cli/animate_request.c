/* The command line of `cuvette animate`. */
#include "cli/animate.h"
#include "base/number.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "image/video.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define SECONDS_MAX 86400.0 /* upper limit of the parameter time_s */
enum { FRAMES_MAX = 10000000, RATE_PART_MAX = 1000000 };

static status take_seconds(const command_option *o, void *request, const char *value, diagnostic *why)
{
    double *seconds = (double *)((char *)request + o->at);
    const bool is_time = number_parse_real(value, seconds) && *seconds >= 0 && *seconds <= SECONDS_MAX;
    char name[32];
    snprintf(name, sizeof name, "--%s", o->name);
    return is_time ? STATUS_OK : options_wrong(name, value, why, "give seconds from 0 to 86400", "invalid time");
}

static int64_t common_divisor(int64_t a, int64_t b)
{
    while (b != 0) {
        int64_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

static status take_rate(const command_option *o, void *context, const char *value, diagnostic *why)
{
    animate_request *request = context;
    (void)o;
    char whole[32];
    const size_t length = strcspn(value, "/");
    int64_t num = 0, den = 1;
    bool right = length < sizeof whole;
    if (right) {
        snprintf(whole, sizeof whole, "%.*s", (int)length, value);
        right = number_parse_int(whole, &num) && (!value[length] || number_parse_int(value + length + 1, &den));
    }
    if (!right || num < 1 || den < 1 || num > RATE_PART_MAX || den > RATE_PART_MAX)
        return options_wrong("--fps", value, why,
                             "give an integer or a fraction of integers up to 1000000, such as 25 or 30000/1001",
                             "invalid frame rate");
    const int64_t divisor = common_divisor(num, den);
    request->times.fps_num = num / divisor;
    request->times.fps_den = den / divisor;
    return STATUS_OK;
}

static const command_option options[] = {
    {"output", 'o', "PATTERN",
     "write frames, .png, .jpg or .pfm, numbered from 0 by one %d or %05d in the name; or one .y4m or .apng file (-: "
     ".y4m to "
     "standard output)",
     OPTION_FILLS(option_text, animate_request, output)},
    {"script", 0, "FILE", "read the hand script of all slimes from FILE",
     OPTION_FILLS(option_text, animate_request, script)},
    {"duration", 0, "S", "length in seconds (default: that of the script plus 2, or 4 without a script)",
     OPTION_FILLS(take_seconds, animate_request, times.duration_s)},
    {"fps", 0, "N", "frames per second, such as 25 (the default) or 30000/1001", .take = take_rate},
    {"start", 0, "S", "time of the first frame, in seconds since the start of the motion (default: 0)",
     OPTION_FILLS(take_seconds, animate_request, times.start_s)},
    OPTION_SET("'toy.stiffness=80'"),
    OPTION_MEMORY,
    {"rows", 0, "FILE", "append one row per frame to a .csv: times, counts, energies",
     OPTION_FILLS(option_text, animate_request, rows)},
    {"restart", 0, NULL, "remove the existing frames and start again",
     OPTION_FILLS(option_flag, animate_request, restart)},
    {"json", 0, NULL, "print the account as one JSON object", OPTION_FILLS(option_flag, animate_request, json)},
    {0},
};

static status check_output(const animate_request *request, diagnostic *why)
{
    if (!request->output)
        return options_wrong("animate", NULL, why,
                             "add -o frames/%05d.png for images, or -o NAME.y4m or NAME.apng for one video file",
                             "no output is given");
    const bool to_stdout = strcmp(request->output, "-") == 0;
    if (to_stdout && request->json)
        return options_wrong("--json", "", why, "give a file with -o",
                             "standard output cannot carry both the video and the account");
    if (to_stdout && isatty(STDOUT_FILENO))
        return options_wrong("-o", "-", why, "redirect it into a file or a pipe", "a terminal cannot show a video");
    if (request->restart && animate_is_stream(request))
        return options_wrong("--restart", "", why, "remove it", "a video file is always written from the start");
    return STATUS_OK;
}

static status check_rows(const animate_request *request, diagnostic *why)
{
    static const char *const endings[] = {".csv"};
    size_t which;
    if (!request->rows)
        return STATUS_OK;
    TRY(outputs_ending("--rows", request->rows, endings, 1, "use a name that ends in .csv", &which, why));
    return outputs_check_folder("--rows", request->rows, why);
}

/* --script is relative to the working folder, whereas the parameter script is relative to the scene's folder. */
static status find_script(animate_request *request, diagnostic *why)
{
    if (!request->script)
        return STATUS_OK;
    struct stat about;
    if (stat(request->script, &about) == 0 && !S_ISREG(about.st_mode))
        return options_wrong("--script", request->script, why,
                             "give a regular file, since a script is read more than once", "not a regular file");
    request->script_path = realpath(request->script, NULL);
    if (request->script_path)
        return STATUS_OK;
    if (errno == ENOMEM)
        return out_of_memory(why);
    return options_wrong("--script", request->script, why, "check the path", "cannot open: %s", strerrordesc_np(errno));
}

static status check_request(void *context, diagnostic *why)
{
    animate_request *request = context;
    TRY(check_output(request, why));
    TRY(check_rows(request, why));
    return find_script(request, why);
}

static const scene_command animate_command = {
    .name = "animate",
    .form = {.options = options,
             .synopsis = "SCENE",
             SCENE_WORD("animate", "-o FILE for an output, "),
             .about =
                 "Render an animation of the scene file SCENE, whose slimes move.\vFrame k shows the time START + k / "
                 "FPS; there are DURATION times FPS frames, rounded, at least one. Existing frames are not rendered "
                 "again: the same command resumes an interrupted animation. For example:\n"
                 "  cuvette animate experiments/scenes/slime.yaml -o frames/%05d.png\n"
                 "  cuvette animate experiments/scenes/slime.yaml -o - | ffmpeg -i - slime.mp4"},
    .check = check_request,
};

status animate_request_parse(int argc, char **argv, animate_request *out, diagnostic *why)
{
    *out = (animate_request){.input.from_beginning = true, .times = {.duration_s = -1, .fps_num = 25, .fps_den = 1}};
    return scene_command_read(&animate_command, argc, argv, out, why);
}

void animate_request_release(animate_request *request)
{
    scene_input_release(&request->input);
    free(request->script_path);
    *request = (animate_request){0};
}

bool animate_is_stream(const animate_request *request)
{
    return strcmp(request->output, "-") == 0 || video_format_of(request->output) != VIDEO_NONE;
}

status animate_check_length(const animate_request *request, diagnostic *why)
{
    const double frames = request->times.duration_s * (double)request->times.fps_num / (double)request->times.fps_den;
    if (frames <= FRAMES_MAX && request->times.start_s + request->times.duration_s <= SECONDS_MAX)
        return STATUS_OK;
    return options_wrong("animate", NULL, why, "give a --duration of at most 10000000 frames that ends within 86400 s",
                         "the animation is too long");
}
