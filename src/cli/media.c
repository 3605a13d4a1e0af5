#include "cli/cli.h"
#include "report/json.h"
#include "report/media_rows.h"
#include "cli/options.h"
#include "base/number.h"
#include <stdbool.h>
#include <stdlib.h>

typedef struct media_request {
    const char *name; /* NULL: all */
    double at_nm;     /* 0: not asked */
    bool json;
} media_request;

static status take_wavelength(const command_option *o, void *into, const char *value, diagnostic *why)
{
    media_request *request = into;
    (void)o;
    return number_parse_real(value, &request->at_nm) && request->at_nm > 0.0
               ? STATUS_OK
               : options_wrong("media", NULL, why, "give nanometres, such as --at 550", "'%.128s' is no wavelength",
                               value);
}

static const command_option options[] = {
    {"at", 0, "NM", "print the index at this wavelength too", .take = take_wavelength},
    {"json", 0, NULL, "print JSON", OPTION_FILLS(option_flag, media_request, json)},
    {0},
};

static const command_form form = {
    .options = options,
    .words = "[NAME]",
    .words_at = offsetof(media_request, name),
    .words_most = 1,
    .excess_remedy = "name one medium, or none for all",
    .excess = "'%.128s' is one too many",
    .about = "Print the catalogue of media: refractive indices at the lines d, F and C, Abbe's number, the range of "
             "wavelengths and the temperature of the measurement, what the indices are relative to, and who measured. "
             "With a name, all about that one: its dispersion law with every coefficient, and what to beware "
             "of.\vIndices are as published, relative to air or to vacuum; for one medium those relative to vacuum "
             "stand beside them. A star marks an index outside the range that was measured. --at never extrapolates.",
};

static status find(const media_request *request, const medium **out, diagnostic *why)
{
    const char **names = calloc(media_count(), sizeof *names);
    if (!names)
        return out_of_memory(why);
    for (size_t i = 0; i < media_count(); i++)
        names[i] = media_at(i)->name;
    int which = 0;
    const status result = options_choice("media", "medium", request->name, names, media_count(), &which, why);
    *out = media_at((size_t)which);
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
    return options_wrong("media", NULL, why, remedy, "%s was not measured at %s nm", m->name, number_format(at_nm, at));
}

static status print(const media_request *request, const medium *only, diagnostic *why)
{
    if (request->json)
        return json_print(media_rows_json(only, request->at_nm), why);
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
    TRY(command_form_read(&form, argc, argv, &request, why));
    if (request.name)
        TRY(find(&request, &only, why));
    if (only)
        TRY(check_range(only, request.at_nm, why));
    return print(&request, only, why);
}
