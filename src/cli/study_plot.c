/* `cuvette study plot`: draws a figure of each study. */
#include "base/file.h"
#include "base/text.h"
#include "cli/options.h"
#include "cli/study.h"
#include "study/plot/plot.h"
#include "study/study.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char *const formats[] = {"png", "svg", "pdf"};
static const double draw_limit_s = 300;
enum { FORMAT_COUNT = sizeof formats / sizeof *formats };

typedef struct request {
    plot_request plot;
    const char **files, **where;
    size_t file_count, where_count;
    const char *output;
    bool wanted[FORMAT_COUNT]; /* by index in formats */
} request;

/* --- the command line --- */

static status parse_formats(const command_option *o, void *context, const char *value, diagnostic *why)
{
    request *r = context;
    (void)o;
    for (const char *word = value; word; word = strchr(word, ','), word = word ? word + 1 : NULL) {
        char name[16];
        int which = 0;
        snprintf(name, sizeof name, "%.*s", (int)(strcspn(word, ",") & 0xFFFF), word);
        TRY(options_choice("--format", "format", name, formats, FORMAT_COUNT, &which, why));
        r->wanted[which] = true;
    }
    return STATUS_OK;
}

static status parse_log(const command_option *o, void *context, const char *value, diagnostic *why)
{
    static const char *const words[] = {"none", "x", "y", "xy"};
    static const plot_log meaning[] = {PLOT_LOG_NONE, PLOT_LOG_X, PLOT_LOG_Y, PLOT_LOG_XY};
    int which = 0;
    (void)o;
    TRY(options_choice("--log", "scale", value, words, 4, &which, why));
    ((request *)context)->plot.log = meaning[which];
    return STATUS_OK;
}

static status parse_where(const command_option *o, void *context, const char *value, diagnostic *why)
{
    request *r = context;
    (void)o;
    (void)why;
    r->where[r->where_count++] = value;
    return STATUS_OK;
}

static void store_file(void *context, const char *file)
{
    request *r = context;
    r->files[r->file_count++] = file;
}

#define PLOT_OPTION(name, form, purpose, field)                                \
    {                                                                          \
        name, 0, form, purpose, OPTION_FILLS(option_text, request, plot.field) \
    }

static const command_option plot_options[] = {
    {"output", 'o', "FIGURE", "figure to write, or a folder (default: results/STUDY/figure.png)",
     OPTION_FILLS(option_text, request, output)},
    {"format", 'f', "LIST", "formats of the figure, separated by commas: png, svg, pdf", .store = parse_formats},
    PLOT_OPTION("x", "PATH", "parameter or column of the x axis", x),
    PLOT_OPTION("y", "COLUMN", "quantity to show: a column of the summary (default: wall_s)", y),
    PLOT_OPTION("by", "PATH", "parameter whose values become lines", by),
    {"log", 0, "AXES", "logarithmic axes: x, y, xy or none (default: by the values)", .store = parse_log},
    {"where", 'w', "PATH=VALUE", "show only cells with this value; can be repeated", .store = parse_where},
    {"images", 0, NULL, "draw the kept images with captions instead", OPTION_FILLS(option_flag, request, plot.images)},
    PLOT_OPTION("published", "CSV", "add numbers from a file with columns of the same names", published),
    {"results", 'r', "DIR", "folder of the results (default: results)",
     OPTION_FILLS(option_text, request, plot.results)},
    {0},
};

static const command_form form = {
    .options = plot_options,
    .store_argument = store_file,
    .synopsis = "FILE...",
    .about =
        "Draw a figure of each study with gnuplot.\vOne numeric parameter gives lines with 95% intervals, two with "
        "at least three values a heat map, words dots; other parameters become lines or panels. The script and "
        "its data are written next to the figure, for editing.",
};

/* --- names --- */

/* Length of the name without its ending; *which: the format of the ending, or -1. */
static size_t stem_length(const char *name, int *which)
{
    const size_t length = strlen(name);
    *which = -1;
    for (int i = 0; i < FORMAT_COUNT; i++)
        if (length > 4 && name[length - 4] == '.' && name[length - 5] != '/' &&
            strcasecmp(name + length - 3, formats[i]) == 0)
            *which = i;
    return *which < 0 ? length : length - 4;
}

static bool ends_in_slash(const char *path)
{
    return path[0] && path[strlen(path) - 1] == '/';
}

static bool is_folder(const char *path)
{
    struct stat about;
    return ends_in_slash(path) || (stat(path, &about) == 0 && S_ISDIR(about.st_mode));
}

/* The figure's path without its ending; fresh memory, or NULL. */
static char *base_of(const request *r, const study *s)
{
    int which;
    if (!r->output)
        return text_format("%s/%s/%s", r->plot.results, s->name, r->plot.images ? "sheet" : "figure");
    if (is_folder(r->output))
        return text_format("%s%s%s%s", r->output, ends_in_slash(r->output) ? "" : "/", s->name,
                           r->plot.images ? "-sheet" : "");
    return text_format("%.*s", (int)stem_length(r->output, &which), r->output);
}

/* The ending if it is of an unsupported format, or NULL; fig.1 and fig.v2 are names. */
static const char *other_format(const char *path)
{
    static const char *const others[] = {".jpg", ".jpeg", ".gif", ".bmp", ".tif", ".tiff", ".webp",
                                         ".eps", ".ps",   ".pfm", ".ppm", ".exr", ".txt",  ".gp"};
    const char *ending = strrchr(path, '.');
    for (size_t i = 0; ending && i < sizeof others / sizeof *others; i++)
        if (strcasecmp(ending, others[i]) == 0)
            return others[i];
    return NULL;
}

static status check(request *r, const char *program, diagnostic *why)
{
    int which = -1;
    bool any = false;
    for (int i = 0; i < FORMAT_COUNT; i++)
        any |= r->wanted[i];
    if (r->output && !is_folder(r->output))
        stem_length(r->output, &which);
    if (!any)
        r->wanted[which < 0 ? 0 : which] = true;
    options_locate(why, program);
    if (r->file_count == 0)
        return diagnose(why, STATUS_BAD_INPUT, "give a study file, such as experiments/depth.study",
                        "no study was given");
    if (!r->plot.results[0])
        return diagnose(why, STATUS_BAD_INPUT, "give a folder", "--results is empty");
    if (r->output && !r->output[0])
        return diagnose(why, STATUS_BAD_INPUT, "give a file or a folder", "--output is empty");
    const char *other = r->output && !is_folder(r->output) && which < 0 ? other_format(r->output) : NULL;
    if (other)
        return diagnose(why, STATUS_BAD_INPUT, "give a name that ends in .png, .svg or .pdf",
                        "a figure cannot be written as %s", other);
    if (r->file_count > 1 && r->output && !is_folder(r->output))
        return diagnose(why, STATUS_BAD_INPUT, "give a folder with a slash at the end, such as figures/",
                        "several studies cannot be drawn into one file");
    if (r->plot.images && (r->plot.x || r->plot.y || r->plot.by || r->plot.published || r->plot.log))
        return diagnose(why, STATUS_BAD_INPUT, "leave out --images, or these options",
                        "--images has no axes: --x, --y, --by, --log and --published are for the other figure");
    *why = (diagnostic){0};
    return STATUS_OK;
}

/* --- figures --- */

static status draw(const request *r, const char *base, const study *s, diagnostic *why)
{
    char *folder = file_next_to(base, ".");
    status code = folder ? file_make_directory(folder, why) : out_of_memory(why);
    free(folder);
    THEN(code, study_plot_write(s, &r->plot, base, why));
    for (int i = 0; code == STATUS_OK && i < FORMAT_COUNT; i++)
        if (r->wanted[i]) {
            code = study_plot_draw(base, formats[i], draw_limit_s, why);
            if (code == STATUS_OK)
                printf("%s: %s.%s\n", s->name, base, formats[i]);
        }
    return code;
}

static status draw_study(const request *r, const char *path, diagnostic *why)
{
    study *s = NULL;
    TRY(study_read(path, &s, why));
    char *base = base_of(r, s);
    status code = base ? study_follow_runs(s, r->plot.results, why) : out_of_memory(why);
    THEN(code, draw(r, base, s, why));
    free(base);
    study_destroy(s);
    return code;
}

status command_study_plot(int argc, char **argv, diagnostic *why)
{
    request r = {.plot = {.results = "results"},
                 .files = calloc((size_t)argc + 1, sizeof *r.files),
                 .where = calloc((size_t)argc + 1, sizeof *r.where)};
    status code = r.files && r.where ? command_form_read(&form, argc, argv, &r, why) : out_of_memory(why);
    THEN(code, check(&r, argv[0], why));
    r.plot.where = r.where;
    r.plot.where_count = r.where_count;
    for (size_t i = 0; code == STATUS_OK && i < r.file_count; i++)
        code = draw_study(&r, r.files[i], why);
    free(r.files);
    free(r.where);
    return code;
}
