/* `cuvette media`: the media catalogue as a table, one medium or a file of optical data in detail, or JSON. */
#include "base/number.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/terminal.h"
#include "report/json.h"
#include "report/param_rows.h"
#include "scene/data/optical_files.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct media_request {
    const char *name;           /* NULL: all */
    double at_nm;               /* 0: not given */
    const char *glass, *column; /* of a file; NULL: not given */
    bool json;
} media_request;

static status parse_wavelength(const command_option *o, void *context, const char *value, diagnostic *why)
{
    media_request *request = context;
    (void)o;
    return number_parse_real(value, &request->at_nm) && request->at_nm > 0.0
               ? STATUS_OK
               : options_wrong("media", NULL, why, "give nanometres, such as --at 550", "invalid wavelength '%.128s'",
                               value);
}

static const command_option options[] = {
    {"at", 0, "NM", "also print the index at this wavelength", .store = parse_wavelength},
    {"glass", 0, "NAME", "glass of a catalogue file", OPTION_FILLS(option_text, media_request, glass)},
    {"column", 0, "NAME", "column of a table, by name or number", OPTION_FILLS(option_text, media_request, column)},
    {"json", 0, NULL, "print JSON", OPTION_FILLS(option_flag, media_request, json)},
    {0},
};

static const command_form form = {
    .options = options,
    .synopsis = "[NAME|FILE]",
    .arguments_at = offsetof(media_request, name),
    .argument_limit = 1,
    .excess_remedy = "give one medium, or none for all",
    .excess = "unexpected argument '%.128s'",
    .about =
        "Print the media catalogue: refractive index at the d, F and C lines, Abbe number, wavelength range and "
        "temperature of the measurement, reference medium (air or vacuum) and source; then the metals with n and "
        "k of their complex index, and their reflectance R_d in vacuum; then named coatings with their reflectance on "
        "bk7. With a name, print all data "
        "for that medium, metal or coating: the dispersion formula with its coefficients, and caveats; with a file of "
        "optical data "
        "(.yml of refractiveindex.info, .agf, .csv), what a scene reads of it.\vIndices are as published, "
        "relative to air or to vacuum; with a name the index relative to vacuum is printed as well. An "
        "asterisk marks an index outside the measured range. --at never extrapolates. On a terminal the lines are "
        "wrapped to "
        "its width; output to a pipe or file is not wrapped.",
};

static status find(const media_request *request, media_choice *out, diagnostic *why)
{
    const size_t media = media_count(), metals = media + metals_count(), count = metals + coating_designs_count();
    const char **names = calloc(count, sizeof *names);
    if (!names)
        return out_of_memory(why);
    for (size_t i = 0; i < count; i++)
        names[i] = i < media    ? media_at(i)->name
                   : i < metals ? metals_at(i - media)->name
                                : coating_design_at(i - metals)->name;
    int which = 0;
    const status result = options_choice("media", "medium", media_usual_name(request->name), names, count, &which, why);
    if ((size_t)which < media)
        out->clear = media_at((size_t)which);
    else if ((size_t)which < metals)
        out->opaque = metals_at((size_t)which - media);
    else
        out->coated = coating_design_at((size_t)which - metals);
    free(names);
    return result;
}

/* For one medium, a wavelength outside the measured range is an error; in the table that index is left out. */
static status check_range(const medium *m, double at_nm, diagnostic *why)
{
    if (at_nm == 0.0 || dispersion_covers(&m->law, at_nm, at_nm))
        return STATUS_OK;
    char at[NUMBER_TEXT_MAX], range[MEDIA_RANGE_MAX], remedy[MEDIA_RANGE_MAX + 64];
    const bool single = m->law.low_nm == m->law.high_nm;
    snprintf(remedy, sizeof remedy,
             single ? "give its only wavelength, %s nm" : "give a wavelength from its range, %s nm",
             media_range_text(m, range));
    return options_wrong("media", NULL, why, remedy, "%s was not measured at %s nm", m->name, number_format(at_nm, at));
}

static status check_metal_range(const metal *m, double at_nm, diagnostic *why)
{
    if (at_nm == 0.0 || metal_covers(m, at_nm))
        return STATUS_OK;
    char at[NUMBER_TEXT_MAX], range[METAL_RANGE_MAX], remedy[METAL_RANGE_MAX + 64];
    snprintf(remedy, sizeof remedy, "give a wavelength from its range, %s nm", metal_range_text(m, range));
    return options_wrong("media", NULL, why, remedy, "%s was not measured at %s nm", m->name, number_format(at_nm, at));
}

static void print_all(double at_nm, int columns)
{
    media_rows_table(stdout, at_nm, columns);
    fputc('\n', stdout);
    metal_rows_table(stdout, at_nm, columns);
    fputc('\n', stdout);
    coating_rows_table(stdout, at_nm, columns);
}

static status print(const media_request *request, media_choice chosen, diagnostic *why)
{
    if (request->json)
        return json_print(media_rows_json(chosen, request->at_nm), why);
    const int columns = terminal_columns(STDOUT_FILENO);
    if (chosen.clear)
        media_rows_details(stdout, chosen.clear, request->at_nm, columns);
    else if (chosen.opaque)
        metal_rows_details(stdout, chosen.opaque, request->at_nm, columns);
    else if (chosen.coated)
        coating_rows_details(stdout, chosen.coated, request->at_nm, columns);
    else
        print_all(request->at_nm, columns);
    return STATUS_OK;
}

/* A name with a dot or a slash is a file. */
static status print_file(const media_request *request, diagnostic *why)
{
    const optical_data *d;
    const optical_file_choice of = {request->glass ? request->glass : "", request->column ? request->column : "", 1.0};
    TRY(optical_file_read(request->name, NULL, &of, &d, why));
    status code = STATUS_OK;
    if (request->json)
        code = json_print(data_rows_json(request->name, d, request->at_nm), why);
    else
        data_rows_details(stdout, request->name, d, request->at_nm, terminal_columns(STDOUT_FILENO));
    optical_data_release(d);
    return code;
}

status command_media(int argc, char **argv, diagnostic *why)
{
    media_request request = {0};
    media_choice chosen = {NULL, NULL, NULL};
    TRY(command_form_read(&form, argc, argv, &request, why));
    if (request.name && strpbrk(request.name, "./"))
        return print_file(&request, why);
    if (request.glass || request.column)
        return options_wrong("media", NULL, why, "give a file such as schott.agf", "--%s needs a file",
                             request.glass ? "glass" : "column");
    if (request.name)
        TRY(find(&request, &chosen, why));
    if (chosen.clear)
        TRY(check_range(chosen.clear, request.at_nm, why));
    if (chosen.opaque)
        TRY(check_metal_range(chosen.opaque, request.at_nm, why));
    return print(&request, chosen, why);
}
