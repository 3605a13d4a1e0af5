#include "cli/cli.h"
#include "report/json.h"
#include "report/media_rows.h"
#include "cli/options.h"
#include "base/number.h"
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

typedef struct media_request {
    const char *name; /* NULL: all */
    double at_nm;     /* 0: not asked */
    bool json;
} media_request;

enum { KEY_JSON = 0x100, KEY_AT };

static const struct argp_option options[] = {
    {"at", KEY_AT, "NM", 0, "print the index at this wavelength too", 0},
    {"json", KEY_JSON, NULL, 0, "print JSON", 0},
    {0},
};

static error_t refuse(diagnostic *why, const char *remedy, const char *what, const char *value)
{
    diagnose(why, STATUS_BAD_INPUT, remedy, "'%.128s' %s", value, what);
    diagnostic_locate(why, "media", 0, 0);
    return EINVAL;
}

static error_t take_option(int key, char *value, struct argp_state *state)
{
    options_input *input = state->input;
    media_request *request = input->request;
    switch (key) {
    case KEY_JSON: request->json = true; return 0;
    case KEY_AT:
        if (!number_parse_real(value, &request->at_nm) || !(request->at_nm > 0.0))
            return refuse(input->why, "give nanometres, such as --at 550", "is no wavelength", value);
        return 0;
    case ARGP_KEY_ARG:
        if (request->name)
            return refuse(input->why, "name one medium, or none for all", "is one too many", value);
        request->name = value;
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp parser = {
    .options = options,
    .parser = take_option,
    .args_doc = "[NAME]",
    .doc =
        "Print the catalogue of media: refractive indices at the lines d, F and C, Abbe's number, the range of "
        "wavelengths "
        "and the temperature of the measurement, what the indices are relative to, and who measured. With a name, all "
        "about that one: its dispersion law with every coefficient, and what to beware of.\v"
        "Indices are as published, relative to air or to vacuum; for one medium those relative to vacuum stand beside "
        "them. A star marks an index outside the range that was measured. --at never extrapolates.",
};

static status find(const media_request *request, const medium **out, diagnostic *why)
{
    const char **names = calloc(media_count(), sizeof *names);
    if (!names)
        return out_of_memory(why);
    for (size_t i = 0; i < media_count(); i++)
        names[i] = media_at(i)->name;
    *out = media_find(request->name);
    status result = STATUS_OK;
    if (!*out) {
        result = options_unknown_word("medium", request->name, names, media_count(), why);
        diagnostic_locate(why, "media", 0, 0);
    }
    free(names);
    return result;
}

/* One medium is refused outside its range; in the table of all such an index is left out. */
static status check_range(const medium *m, double at_nm, diagnostic *why)
{
    if (at_nm == 0.0 || dispersion_covers(&m->law, at_nm, at_nm))
        return STATUS_OK;
    char at[NUMBER_TEXT_MAX], range[MEDIA_RANGE_MAX], remedy[MEDIA_RANGE_MAX + 64];
    const bool single = m->law.low_nm == m->law.high_nm;
    snprintf(remedy, sizeof remedy, single ? "its one wavelength is %s nm" : "give a wavelength from its range, %s nm",
             media_range_text(m, range));
    diagnose(why, STATUS_BAD_INPUT, remedy, "%s was not measured at %s nm", m->name, number_format(at_nm, at));
    diagnostic_locate(why, "media", 0, 0);
    return STATUS_BAD_INPUT;
}

static status print(const media_request *request, const medium *only, diagnostic *why)
{
    if (request->json) {
        json_t *all = media_rows_json(only, request->at_nm);
        status result = json_write(stdout, all, why);
        json_decref(all);
        return result;
    }
    if (only)
        media_rows_details(stdout, only, request->at_nm);
    else
        media_rows_table(stdout, request->at_nm);
    return STATUS_OK;
}

status command_media(int argc, char **argv, diagnostic *why)
{
    media_request request = {0};
    const medium *only = NULL;
    status result = options_parse(&parser, 0, argc, argv, &request, why);
    if (result == STATUS_OK && request.name)
        result = find(&request, &only, why);
    if (result == STATUS_OK && only)
        result = check_range(only, request.at_nm, why);
    return result == STATUS_OK ? print(&request, only, why) : result;
}
