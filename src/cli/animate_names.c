/* File names of an animation's frames: parsing of the pattern, name of a frame, frame of a name. */
#include "cli/animate.h"
#include "base/file.h"
#include "base/text.h"
#include "cli/outputs.h"
#include "image/image.h"
#include <ctype.h>
#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

enum { DIGITS_MAX = 18 }; /* such a number fits into 64 bits */

static status wrong(const char *pattern, const char *remedy, const char *what, diagnostic *why)
{
    return options_wrong("-o", pattern, why, remedy, "%s", what);
}

static const char number_form[] = "write one %d, or %05d for five digits; write %% for a percent sign";

/* The length of the conversion "%d" or "%05d" at text; 0 for any other. */
static size_t conversion_length(const char *text, int *digits)
{
    size_t at = 1;
    *digits = 0;
    if (text[at] == '0')
        for (at++; isdigit((unsigned char)text[at]) && *digits <= DIGITS_MAX; at++)
            *digits = 10 * *digits + (text[at] - '0');
    bool right = text[at] == 'd' && *digits <= DIGITS_MAX && (at == 1 || *digits > 0);
    return right ? at + 1 : 0;
}

/* Splits name at its number; %% becomes %. */
static status split(const char *pattern, const char *name, animate_names *out, diagnostic *why)
{
    char *part = out->before;
    for (const char *at = name; *at;) {
        if (*at != '%' || at[1] == '%') {
            *part++ = *at;
            at += *at == '%' ? 2 : 1;
            continue;
        }
        int digits;
        size_t length = conversion_length(at, &digits);
        if (length == 0)
            return wrong(pattern, number_form, "invalid frame number after '%'", why);
        if (out->digits >= 0)
            return wrong(pattern, number_form, "the name has more than one frame number", why);
        out->digits = digits;
        part = out->after;
        at += length;
    }
    return out->digits >= 0 ? STATUS_OK : wrong(pattern, number_form, "the name has no frame number", why);
}

status animate_names_parse(const char *pattern, animate_names *out, diagnostic *why)
{
    const char *name = file_name_of(pattern);
    *out = (animate_names){.pattern = pattern, .digits = -1};
    if (image_format_of(name) == IMAGE_UNKNOWN)
        return wrong(pattern, "use .png, .jpg or .pfm for frames, .y4m or .apng for one video file",
                     "unknown file name ending", why);
    if (memchr(pattern, '%', (size_t)(name - pattern)))
        return wrong(pattern, "number the files, not their folder", "the folder's name has a %", why);
    out->folder = outputs_folder_of(pattern);
    out->before = calloc(1, strlen(name) + 1);
    out->after = calloc(1, strlen(name) + 1);
    if (!out->folder || !out->before || !out->after)
        return out_of_memory(why);
    return split(pattern, name, out, why);
}

void animate_names_release(animate_names *names)
{
    free(names->folder);
    free(names->before);
    free(names->after);
    *names = (animate_names){0};
}

char *animate_name(const animate_names *names, int64_t frame)
{
    return text_format("%s/%s%0*" PRId64 "%s", strcmp(names->folder, "/") == 0 ? "" : names->folder, names->before,
                       names->digits, frame, names->after);
}

int64_t animate_name_frame(const animate_names *names, const char *name)
{
    const size_t before = strlen(names->before), after = strlen(names->after), length = strlen(name);
    if (length <= before + after || strncmp(name, names->before, before) != 0 ||
        strcmp(name + length - after, names->after) != 0)
        return -1;
    const char *digits = name + before;
    const size_t count = length - before - after;
    if (count > DIGITS_MAX || count < (size_t)names->digits || strspn(digits, "0123456789") < count)
        return -1;
    if (digits[0] == '0' && count > 1 && count > (size_t)names->digits)
        return -1; /* printf writes no further leading zeros */
    return strtoll(digits, NULL, 10);
}
