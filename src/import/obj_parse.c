/* The statements of an OBJ file, line by line. No function reads beyond the line end of its line, unless \ continues
 * it. */
#include "base/array.h"
#include "base/number.h"
#include "import/obj.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ROOM_FOR_ONE(o, array, room, count) ((o)->count < (o)->room || GROW((o)->array, (o)->room, (o)->count + 1))

/* --- words --- */

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\f' || c == '\v';
}

/* The end of a statement: the end of its line, or a comment. */
static bool is_end(char c)
{
    return c == '\n' || c == '\r' || c == '#';
}

/* Moves past blanks, and past a line end after \. */
static const char *skip_blanks(obj_part *o, const char *p)
{
    for (;; p++) {
        if (*p == '\\' && (p[1] == '\n' || p[1] == '\r')) {
            p += p[1] == '\r' && p[2] == '\n' ? 2 : 1;
            o->line++;
            if (p + 1 >= o->end)
                return p; /* the line end of the part's last line */
        } else if (!is_blank(*p)) {
            return p;
        }
    }
}

/* Moves past the end of the line. */
static const char *next_line(obj_part *o, const char *p)
{
    while (*p != '\n' && *p != '\r')
        p++;
    o->line++;
    return p + (p[0] == '\r' && p + 1 < o->end && p[1] == '\n' ? 2 : 1);
}

/* Records a mistake, and the word that begins at p, if there is one; returns NULL. */
static const char *fail(obj_part *o, const char *p, const char *fault, const char *remedy)
{
    o->fault = fault;
    o->remedy = remedy;
    o->word = p;
    while (!is_blank(*p) && *p != '\n' && *p != '\r')
        p++;
    o->word_length = (size_t)(p - o->word);
    return NULL;
}

/* Skips a statement that is not read. \ continues it, unless it is a comment. */
static const char *skip_statement(obj_part *o, const char *p)
{
    const bool comment = *p == '#';
    const char *end = p;
    for (;; end++) {
        while (*end != '\n' && *end != '\r')
            end++;
        if (comment || end == p || end[-1] != '\\')
            return next_line(o, end);
        const char *next = end + (end[0] == '\r' && end + 1 < o->end && end[1] == '\n' ? 2 : 1);
        if (next >= o->end)
            return next_line(o, end);
        o->line++;
        end = next - 1;
    }
}

static const char *no_memory(obj_part *o)
{
    o->no_memory = true;
    return NULL;
}

/* --- v, vt, vn --- */

/* What one of these statements may have. */
typedef struct form {
    int least, most; /* numbers */
    double far;      /* the largest magnitude of the first three */
    const char *word, *few, *remedy;
} form;

static const form place_form = {3,
                                3,
                                MESH_WIRE_FAR,
                                "a vertex has a word that is not a finite number within 1e9",
                                "a vertex has fewer than three numbers",
                                "give three finite numbers"};
static const form uv_form = {1,
                             3,
                             HUGE_VAL,
                             "a texture coordinate has a word that is not a finite number",
                             "a texture coordinate has no numbers",
                             "give two finite numbers"};
static const form normal_form = {3,
                                 3,
                                 HUGE_VAL,
                                 "a normal has a word that is not a finite number",
                                 "a normal has fewer than three numbers",
                                 "give three finite numbers"};

/* Reads the colour of the next place, if at least three numbers follow its coordinates: red, green, blue, and perhaps
 * alpha. A single number is a weight. Moves past them. False: out of memory. */
static bool read_color(obj_part *o, const char **at)
{
    static const double white[3] = {1.0, 1.0, 1.0};
    int count = 0;
    double v[4] = {0.0, 0.0, 0.0, 1.0}, unused;
    for (*at = skip_blanks(o, *at); !is_end(**at) && number_scan(at, count < 4 ? &v[count] : &unused);
         *at = skip_blanks(o, *at))
        count++;
    if (count < 3)
        return true;
    if (o->place_count >= o->color_room && !GROW(o->colors, o->color_room, o->place_count + 1))
        return false;
    for (; o->color_count < o->place_count; o->color_count++)
        memcpy(o->colors[o->color_count], white, sizeof white);
    memcpy(o->colors[o->color_count++], v, sizeof *o->colors);
    o->clear |= v[3] < 1.0;
    return true;
}

/* Reads the numbers of a statement. The weight of a place is not used: x, y, z are as written. */
static const char *read_numbers(obj_part *o, const char *p, const form *f, double v[3])
{
    int count = 0;
    for (; count < f->most; count++) {
        p = skip_blanks(o, p);
        if (is_end(*p))
            break;
        const char *word = p;
        if (!number_scan(&p, &v[count]) || !(is_blank(*p) || is_end(*p) || *p == '\\') || fabs(v[count]) > f->far)
            return fail(o, word, f->word, f->remedy);
    }
    if (count < f->least)
        return fail(o, p, f->few, f->remedy);
    p = skip_blanks(o, p);
    if (f == &place_form && !is_end(*p) && !read_color(o, &p))
        return no_memory(o);
    return skip_statement(o, p);
}

/* Reads a place or a normal into its list. */
static const char *read_vector(obj_part *o, const char *p, const form *f, double (**list)[3], size_t *room,
                               size_t *count)
{
    double v[3];
    if (*count == *room && !GROW(*list, *room, *count + 1))
        return no_memory(o);
    p = read_numbers(o, p, f, v);
    if (p)
        memcpy((*list)[(*count)++], v, sizeof **list);
    return p;
}

static const char *read_uv(obj_part *o, const char *p)
{
    double v[3] = {0.0, 0.0};
    if (!ROOM_FOR_ONE(o, uvs, uv_room, uv_count))
        return no_memory(o);
    p = read_numbers(o, p, &uv_form, v);
    memcpy(o->uvs[o->uv_count++], v, sizeof *o->uvs);
    return p;
}

/* --- f --- */

/* Reads an index, of the `count` statements so far if it is relative: -1 is the last one. */
static bool read_index(obj_part *o, const char **at, size_t count, int32_t *index)
{
    const char *p = *at;
    const bool negative = *p == '-';
    int64_t value = 0;
    p += negative || *p == '+';
    const char *digits = p;
    for (; *p >= '0' && *p <= '9'; p++)
        value = value > OBJ_INDEX_MAX ? value : 10 * value + (*p - '0');
    if (p == digits || value == 0 || value > OBJ_INDEX_MAX || count > OBJ_INDEX_MAX)
        return false;
    *index = negative ? (int32_t)((int64_t)count + 1 - value - OBJ_RELATIVE) : (int32_t)value;
    o->relative |= negative;
    *at = p;
    return true;
}

static int32_t larger(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

/* Reads a corner: place, place/uv, place//normal or place/uv/normal. */
static bool read_corner(obj_part *o, const char **at, obj_corner *c)
{
    *c = (obj_corner){0, 0, 0};
    if (!read_index(o, at, o->place_count, &c->place))
        return false;
    for (int k = 0; k < 2 && **at == '/'; k++) {
        ++*at;
        const bool given = **at == '-' || **at == '+' || (**at >= '0' && **at <= '9');
        if (given &&
            !(k == 0 ? read_index(o, at, o->uv_count, &c->uv) : read_index(o, at, o->normal_count, &c->normal)))
            return false;
    }
    o->highest = (obj_corner){larger(o->highest.place, c->place), larger(o->highest.uv, c->uv),
                              larger(o->highest.normal, c->normal)};
    return is_blank(**at) || is_end(**at) || **at == '\\';
}

/* Records a face, whose corners are recorded already. Sizes are stored from the first polygon on. */
static bool add_face(obj_part *o, uint32_t size)
{
    if (size > 3 && !o->sizes) {
        if (!GROW(o->sizes, o->size_room, o->face_count + 1))
            return false;
        for (size_t i = 0; i < o->face_count; i++)
            o->sizes[i] = 3;
    }
    if (o->sizes) {
        if (!ROOM_FOR_ONE(o, sizes, size_room, face_count))
            return false;
        o->sizes[o->face_count] = size;
    }
    o->face_count++;
    return true;
}

static const char *read_face(obj_part *o, const char *p)
{
    const size_t first = o->corner_count;
    for (p = skip_blanks(o, p); !is_end(*p); p = skip_blanks(o, p)) {
        const char *word = p;
        if (!ROOM_FOR_ONE(o, corners, corner_room, corner_count))
            return no_memory(o);
        if (!read_corner(o, &p, &o->corners[o->corner_count++]))
            return fail(o, word, "a corner of a face is invalid",
                        "give indices of vertices, such as 1, 1/1, 1//1 or 1/1/1");
        if (o->corner_count - first > POLYGON_MAX)
            return fail(o, word, "a face has more than 65536 corners", "divide it into triangles");
    }
    const size_t count = o->corner_count - first;
    if (count < 3) {
        o->corner_count = first;
        o->narrow = true;
    } else if (!add_face(o, (uint32_t)count)) {
        return no_memory(o);
    }
    return next_line(o, p);
}

/* --- usemtl, mtllib; the rest --- */

/* Records the names in the rest of the line. */
static const char *read_names(obj_part *o, const char *p, bool library)
{
    while (is_blank(*p))
        p++;
    const char *end = p;
    while (*end != '\n' && *end != '\r')
        end++;
    const char *zero = memchr(p, 0, (size_t)(end - p));
    size_t length = (size_t)((zero ? zero : end) - p);
    while (length > 0 && is_blank(p[length - 1]))
        length--;
    if (!GROW(o->events, o->event_room, o->event_count + 1))
        return no_memory(o);
    o->events[o->event_count++] = (obj_event){o->face_count, length, p, o->line, library};
    return next_line(o, end);
}

/* The end of the keyword at p if a blank follows it; NULL: another one. */
static const char *after(const char *p, const char *keyword)
{
    for (; *keyword; p++, keyword++)
        if (*p != *keyword)
            return NULL;
    return is_blank(*p) || *p == '\n' || *p == '\r' || *p == '\\' ? p : NULL;
}

static const char *read_line(obj_part *o, const char *p)
{
    const char *rest;
    while (is_blank(*p))
        p++;
    if ((rest = after(p, "v")))
        return read_vector(o, rest, &place_form, &o->places, &o->place_room, &o->place_count);
    if ((rest = after(p, "f")) || (rest = after(p, "fo"))) /* fo: an older name */
        return read_face(o, rest);
    if ((rest = after(p, "vt")))
        return read_uv(o, rest);
    if ((rest = after(p, "vn")))
        return read_vector(o, rest, &normal_form, &o->normals, &o->normal_room, &o->normal_count);
    if ((rest = after(p, "usemtl")))
        return read_names(o, rest, false);
    if ((rest = after(p, "mtllib")))
        return read_names(o, rest, true);
    return skip_statement(o, p);
}

void obj_parse(obj_part *o)
{
    for (const char *at = o->begin; at && at < o->end && (o->until == 0 || o->face_count < o->until);)
        at = read_line(o, at);
}

uint32_t obj_face_line(const obj_part *part, size_t face)
{
    obj_part again = {.begin = part->begin, .end = part->end, .until = face + 1};
    obj_parse(&again);
    const uint32_t line = again.line - 1;
    obj_part_release(&again);
    return line;
}

void obj_part_release(obj_part *o)
{
    free(o->places), free(o->uvs), free(o->normals), free(o->colors);
    free(o->corners), free(o->sizes), free(o->events);
}
