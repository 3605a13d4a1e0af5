/* Notes on a study before it runs: collected over all cells, and printed once each with their cells. */
#include "base/array.h"
#include "cli/scene_input.h"
#include "cli/study.h"
#include "cli/terminal.h"
#include "lint/lint.h"
#include "measure/clock.h"
#include "scene/model/scene.h"
#include "study/plan/grid.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

static const double trace_budget_s = 1.0;
/* A note on a fifth of the cells is missed by 12 of them in one study of fifteen. */
enum { TRACED_CELLS = 12 };

/* A note, and the cells that have it; texts that differ only in numbers are one note. */
typedef struct found_note {
    scene_note note; /* of the first cell */
    size_t first, last, cells;
    bool traced, differs; /* differs: in the numbers */
    bool needs_all_cells; /* printed only if all cells have it */
    bool dropped;         /* not printed */
} found_note;

typedef struct collector {
    const study *s;
    found_note *found;
    size_t count;
    size_t cell, weight; /* the current cell, and the number of cells that it stands for */
    bool traced, needs_all_cells, out_of_memory;
    bool keeps_intended; /* keeps notes on what the study varies, too */
} collector;

/* --- what the study varies --- */

/* Returns whether path equals place or is an element of it ("lamp.position.x" of "lamp.position"). */
static bool is_part(const char *place, const char *path)
{
    const size_t length = strlen(place);
    return strncmp(place, path, length) == 0 && (path[length] == '\0' || path[length] == '.');
}

/* Returns whether place is a solid's parameter and path the same parameter of its material. */
static bool is_of_material(const scene *s, const char *place, const char *path)
{
    const char *dot = strchr(place, '.');
    char name[SCENE_NAME_MAX + 1], material_path[NOTE_PLACE_MAX];
    if (!dot || (size_t)(dot - place) >= sizeof name)
        return false;
    snprintf(name, sizeof name, "%.*s", (int)(dot - place), place);
    const int solid_index = scene_find_solid(s, name);
    if (solid_index < 0 || s->solids[solid_index].material_index < 0)
        return false;
    snprintf(material_path, sizeof material_path, "%s%s", s->materials[s->solids[solid_index].material_index].name,
             dot);
    return is_part(material_path, path);
}

static bool varies(const study *s, const char *place)
{
    for (size_t a = 0; a < s->axis_count; a++)
        for (size_t i = 0; i < s->axes[a].points[0].count; i++) {
            const char *path = s->axes[a].points[0].paths[i];
            if (is_part(place, path) || is_part(path, place) || is_of_material(s->base, place, path))
                return true;
        }
    return false;
}

/* --- collecting --- */

static bool is_number(char c)
{
    return isdigit((unsigned char)c) || c == '.';
}

static bool same_but_numbers(const char *a, const char *b)
{
    for (;;) {
        while (is_number(*a))
            a++;
        while (is_number(*b))
            b++;
        if (*a != *b)
            return false;
        if (!*a)
            return true;
        a++;
        b++;
    }
}

/* A sweep over a quantity passes through unusual values on purpose: hints on this quantity are dropped, except hints on
 * the range in which a medium was measured. */
static bool is_intended(const collector *c, const char *place)
{
    if (c->keeps_intended)
        return false;
    return c->traced ? strcmp(place, "render.depth") == 0 && varies(c->s, place) : varies(c->s, place);
}

/* Adds a note. A dropped note is added, too: the linter repeats the hints, and its note of the same place and text is
 * then ignored. */
static void add_note(void *context, const scene_note *note)
{
    collector *c = context;
    for (size_t i = 0; i < c->count; i++) {
        found_note *f = &c->found[i];
        if (strcmp(f->note.place, note->place) != 0 || !same_but_numbers(f->note.text, note->text))
            continue;
        if (f->traced == c->traced && f->last != c->cell) {
            f->last = c->cell;
            f->cells += c->weight;
            f->differs |= strcmp(f->note.text, note->text) != 0;
        }
        return;
    }
    if (!room_for_one(&c->found, c->count, sizeof *c->found)) {
        c->out_of_memory = true;
        return;
    }
    c->found[c->count++] = (found_note){.note = *note,
                                        .first = c->cell,
                                        .last = c->cell,
                                        .cells = c->weight,
                                        .traced = c->traced,
                                        .needs_all_cells = c->needs_all_cells,
                                        .dropped = is_intended(c, note->place)};
}

/* --- notes that need no rays --- */

static bool has_note_at(const collector *c, const char *place)
{
    for (size_t i = 0; i < c->count; i++)
        if (!c->found[i].dropped && c->found[i].last == c->cell && strcmp(c->found[i].note.place, place) == 0)
            return true;
    return false;
}

static void ask_inert(collector *c, const scene *setting, const char *path)
{
    inert_answer answer;
    if (!has_note_at(c, path) && param_is_inert(setting, path, NULL, &answer))
        add_note(c, &answer.note);
}

/* A parameter that is fixed, or set with others at a point, may be meant for some cells only. The values of an axis
 * with one parameter are meant to differ: if they have no effect, cells repeat one another. */
static void ask_all_inert(collector *c, const scene *setting)
{
    const study *s = c->s;
    c->needs_all_cells = c->keeps_intended = true;
    for (size_t i = 0; i < s->fixed.count; i++)
        ask_inert(c, setting, s->fixed.paths[i]);
    for (size_t a = 0; a < s->axis_count; a++) {
        const study_point *point = &s->axes[a].points[0];
        c->needs_all_cells = point->count > 1;
        for (size_t i = 0; i < point->count; i++)
            ask_inert(c, setting, point->paths[i]);
    }
    c->needs_all_cells = c->keeps_intended = false;
}

static status note_settings(collector *c, diagnostic *why)
{
    const note_sink taker = {add_note, c};
    c->weight = 1;
    for (c->cell = 0; c->cell < study_cell_count(c->s); c->cell++) {
        scene *setting;
        TRY(study_cell_scene(c->s, c->cell, &setting, why));
        c->keeps_intended = true;
        scene_range_hints(setting, &taker);
        c->keeps_intended = false;
        scene_hints(setting, &taker);
        ask_all_inert(c, setting);
        scene_destroy(setting);
    }
    return STATUS_OK;
}

/* --- notes from traced rays --- */

static status trace_cell(collector *c, isa level, diagnostic *why)
{
    scene *setting;
    TRY(study_cell_scene(c->s, c->cell, &setting, why));
    bool moves = false;
    for (size_t i = 0; i < setting->mesh_count; i++)
        moves |= setting->meshes[i].source == MESH_SLIME;
    status code = moves ? scene_load_files(setting, why) : scene_load(setting, why);
    THEN(code, lint_scene(setting, level, &(note_sink){add_note, c}, why));
    scene_destroy(setting);
    return code;
}

/* Examines the cells with different films in a random order; *examined is the number of cells that they stand for. */
static status trace_cells(collector *c, size_t *order, size_t *weights, size_t *examined, diagnostic *why)
{
    const size_t total = study_cell_count(c->s);
    const double began_s = clock_wall_s();
    isa level = ISA_BASE;
    TRY(scene_input_isa(&level, why));
    for (size_t cell = 0; cell < total; cell++) {
        order[cell] = cell;
        weights[study_cell_film(c->s, cell)]++;
    }
    order_shuffle(1, 0, order, total);
    c->traced = true;
    size_t traced = 0;
    for (size_t i = 0; i < total && traced < TRACED_CELLS; i++) {
        c->cell = order[i];
        c->weight = weights[c->cell];
        if (c->weight == 0)
            continue;
        if (traced++ > 0 && clock_wall_s() - began_s > trace_budget_s)
            break;
        *examined += c->weight;
        TRY(trace_cell(c, level, why));
    }
    return STATUS_OK;
}

/* --- printing --- */

/* "cell 3 (liquid.ior=1.4, render.depth=2)" */
static void cell_text(const study *s, size_t cell, char *text, size_t size)
{
    size_t used = (size_t)snprintf(text, size, "cell %zu", cell);
    const char *before = " (";
    for (size_t a = 0; a < s->axis_count; a++) {
        const study_point *point = &s->axes[a].points[study_cell_point(s, cell, a)];
        for (size_t i = 0; i < point->count && used < size; i++) {
            used +=
                (size_t)snprintf(text + used, size - used, "%s%.64s=%.32s", before, point->paths[i], point->values[i]);
            before = ", ";
        }
    }
    if (s->axis_count && used < size)
        snprintf(text + used, size - used, ")");
}

/* Whether the notes differ only in the object: ten drops of one liquid. */
static bool same_but_object(const found_note *a, const found_note *b)
{
    const char *x = strchr(a->note.place, '.'), *y = strchr(b->note.place, '.');
    return x && y && strcmp(x, y) == 0 && strcmp(a->note.text, b->note.text) == 0 &&
           strcmp(a->note.remedy, b->note.remedy) == 0 && a->first == b->first && a->cells == b->cells &&
           a->traced == b->traced && a->needs_all_cells == b->needs_all_cells && !a->dropped && !b->dropped;
}

/* Keeps the first of notes that differ only in the object, and adds the number of the others to its place. */
static void merge_objects(collector *c)
{
    for (size_t i = 0; i < c->count; i++) {
        scene_note *note = &c->found[i].note;
        size_t others = 0;
        for (size_t k = i + 1; k < c->count; k++)
            if (same_but_object(&c->found[i], &c->found[k])) {
                c->found[k].dropped = true;
                others++;
            }
        const size_t length = strlen(note->place);
        if (others)
            snprintf(note->place + length, sizeof note->place - length, " (also of %zu other%s)", others,
                     others == 1 ? "" : "s");
    }
}

static void print_found(const study *s, const found_note *f, size_t examined)
{
    const size_t total = f->traced ? examined : study_cell_count(s);
    const char *which = total < study_cell_count(s) ? " examined" : "";
    char line[NOTE_LINE_MAX], cell[300], text[NOTE_LINE_MAX + 400];
    if (f->dropped || (f->needs_all_cells && f->cells < total))
        return;
    note_line(&f->note, line, sizeof line);
    cell_text(s, f->first, cell, sizeof cell);
    if (f->cells == total && !f->differs)
        snprintf(text, sizeof text, "%s", line);
    else if (f->cells == total)
        snprintf(text, sizeof text, "in all %zu%s cells, such as %s: %s", total, which, cell, line);
    else if (f->cells > 1)
        snprintf(text, sizeof text, "in %zu of %zu%s cells, such as %s: %s", f->cells, total, which, cell, line);
    else
        snprintf(text, sizeof text, "in %s: %s", cell, line);
    terminal_note(text);
}

status study_notes_print_cells(const study *s, diagnostic *why)
{
    const size_t total = study_cell_count(s);
    collector c = {.s = s};
    size_t *order = calloc(total, sizeof *order), *weights = calloc(total, sizeof *weights), examined = 0;
    status code = order && weights ? STATUS_OK : out_of_memory(why);
    THEN(code, note_settings(&c, why));
    THEN(code, trace_cells(&c, order, weights, &examined, why));
    if (code == STATUS_OK && c.out_of_memory)
        code = out_of_memory(why);
    merge_objects(&c);
    for (size_t i = 0; code == STATUS_OK && i < c.count; i++)
        print_found(s, &c.found[i], examined);
    free(c.found);
    free(weights);
    free(order);
    return code;
}

void study_notes_print_file(const study *s)
{
    for (size_t i = 0; i < s->note_count; i++) {
        char line[NOTE_LINE_MAX], text[NOTE_LINE_MAX + 400];
        snprintf(text, sizeof text, "%.350s:%ld:%ld: %s", s->path, s->notes[i].line, s->notes[i].column,
                 note_line(&s->notes[i].note, line, sizeof line));
        terminal_note(text);
    }
}
