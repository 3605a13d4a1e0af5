/* The parameter table as text, one line per parameter; as JSON, for the page and `cuvette params --json`; and as roff
 * for the manual page. param_lines.c collects the lines. */
#pragma once

#include "lens/lens.h"
#include "optics/coating.h"
#include "optics/media.h"
#include "optics/optical_data.h"
#include "realism/realism.h"
#include "scene/model/params.h"
#include "scene/model/solids.h"
#include "softbody/trials.h"
#include <jansson.h>
#include <stdio.h>

/* The lines of a table: all parameters, or those of a scene with their values, or those that match a filter. Ownership:
 * param_lines_release frees the lines that param_lines_collect allocated, also after an error. */
enum { PARAM_PATH_MAX = 400 };

typedef struct param_line {
    char *path, *value; /* without a scene the value is the default */
    const param *row;
} param_line;

typedef struct param_lines {
    param_line *line;
    size_t count;
} param_lines;

/* filter: as for param_rows_print; of: only these parameters of the scene; s, of and filter may be NULL. */
status param_lines_collect(const scene *s, const param_selection *of, const char *filter, param_lines *out,
                           diagnostic *why);
void param_lines_release(param_lines *all);

/* The path of a row, such as "render.depth"; "LIGHT.intensity" for objects, whose names the scene defines. Returns
 * text. */
char *param_lines_path(const param *row, char *text, size_t size);

/* Prints the table; with a scene, all its parameters with their values. filter: NULL, or a path, group or name of
 * parameters, or a word in their path or meaning; STATUS_BAD_INPUT if it matches none. columns: width of the terminal
 * to which meanings are wrapped; 0: no wrapping. */
status param_rows_print(FILE *stream, const scene *s, const char *filter, int columns, diagnostic *why);

/* The table as JSON; the caller owns *out. opened: NULL, or, for the page, an earlier state of the scene, whose values
 * become `initial` (null: no such parameter). Rows of `ior` then have `first_coefficients`, {LAW: initial numbers}.
 * of: NULL, or only these. */
status param_rows_json(const scene *s, const scene *opened, const param_selection *of, const char *filter, json_t **out,
                       diagnostic *why);

/* Prints the generated part of cuvette-scene(5). */
void param_rows_manual(FILE *stream);

/* The catalogues of media, metals and coatings as tables, one entry in detail, or JSON. at_nm is a further wavelength;
 * 0: none. Ownership: the JSON is a new reference. Errors of the stream stay in the stream, where the caller checks
 * them. */

enum { MEDIA_RANGE_MAX = 72 };

/* "210..3710"; "589.3" for a single wavelength; "-" if the range is unknown. Returns text. */
char *media_range_text(const medium *m, char text[MEDIA_RANGE_MAX]);

/* columns: width of the terminal to which lines are wrapped; 0: no wrapping. */
void media_rows_table(FILE *stream, double at_nm, int columns);
void media_rows_details(FILE *stream, const medium *m, double at_nm, int columns);

/* Whether the table of the metal covers the wavelength. */
bool metal_covers(const metal *m, double lambda_nm);
/* "367.9..821.1"; returns text. */
enum { METAL_RANGE_MAX = 72 };
char *metal_range_text(const metal *m, char text[METAL_RANGE_MAX]);

void metal_rows_table(FILE *stream, double at_nm, int columns);
void metal_rows_details(FILE *stream, const metal *m, double at_nm, int columns);

/* Designs of coatings, with their reflectance in air on bk7. */
void coating_rows_table(FILE *stream, double at_nm, int columns);
void coating_rows_details(FILE *stream, const coating_design *d, double at_nm, int columns);

/* An entry of a catalogue; the other pointers are NULL. */
typedef struct media_choice {
    const medium *clear;
    const metal *opaque;
    const coating_design *coated;
} media_choice;

/* The given entry, or all catalogues if there is none. Returns NULL when out of memory. */
json_t *media_rows_json(media_choice only, double at_nm);

/* Data from a file in detail, or as JSON, with the law of n, or NULL. */
void data_rows_details(FILE *stream, const char *file, const optical_data *d, double at_nm, int columns);
json_t *data_rows_json(const char *file, const optical_data *d, double at_nm);

/* Writers of measured values next to theory, as CSV and JSON, for the laboratory and for `cuvette realism` (metrics and
 * curves of optics) and `cuvette motion` (the motion of slimes). Errors of the stream stay in the stream. Ownership:
 * everything is borrowed; JSON is a new reference, NULL when out of memory. */

/* "pass", "FAIL", or "none" for a metric that the scene does not have. */
const char *realism_verdict(const realism_value *v);

/* The formats are in cuvette-realism(1). */
void realism_write_csv(const realism_report *r, FILE *out);
json_t *realism_json(const realism_report *r, const char *scene_path);
void realism_write_curve(realism_curve which, const realism_points *points, FILE *out);
/* {"name", "x", "y", "points": [[x, measured, theory], ..]} */
json_t *realism_curve_json(realism_curve which, const realism_points *points);

/* The name of the slime's integrator. */
const char *motion_integrator(const mesh_entry *m);

/* The formats are in cuvette-motion(1). The CSV has one header for all slimes. */
void motion_write_csv_header(FILE *out);
void motion_write_csv(const mesh_entry *m, const softbody_trial_report *r, FILE *out);
json_t *motion_slime_json(const mesh_entry *m, const softbody_trial_report *r);
/* slimes: a list of the objects of motion_slime_json; its reference is stolen. */
json_t *motion_json(json_t *slimes, const char *scene_path);

/* Writes the report of a lens (lens/lens.h): its sections as tables of text, as CSV with a row for each number, and as
 * JSON with a list for each column. Ownership: lens_table_make allocates, lens_table_release frees; a report is
 * borrowed, and texts are its constants. Errors of streams stay in the stream. */

enum { LENS_COLUMNS_MAX = 32 };

/* The rows of a section that agree in their keys, as records. */
typedef struct lens_table {
    const lens_section *section;
    const char *quantity[LENS_COLUMNS_MAX], *unit[LENS_COLUMNS_MAX];
    int columns;
    size_t count;
    lens_row *key; /* of each record */
    double *value; /* record by record, LENS_COLUMNS_MAX each; NaN where a record lacks the quantity */
    bool has_surface, has_field, has_lambda, has_x;
} lens_table;

status lens_table_make(const lens_report *r, const lens_section *section, lens_table *out, diagnostic *why);
void lens_table_release(lens_table *t);

/* columns: of the terminal, 0 for none. */
status lens_write_text(const lens_report *r, const char *title, int columns, FILE *out, diagnostic *why);
void lens_write_csv(const lens_report *r, FILE *out);
/* NULL when out of memory. */
json_t *lens_json(const lens_report *r, const char *title);
