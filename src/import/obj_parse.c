/* The statements of an OBJ file, line by line. No function reads beyond the \n of its line. */
#include "base/array.h"
#include "import/obj.h"
#include <math.h>
#include <string.h>

/* --- numbers, as assimp rounds them, independent of the locale --- */

enum { INTEGER_MAX = 18, FRACTION_MAX = 15, EXPONENT_MAX = 3 }; /* largest numbers of digits */

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Reads up to `most` digits; returns how many there are. */
static int digits(const char **at, int most, uint64_t *value)
{
    const char *p = *at;
    uint64_t sum = 0;
    for (; is_digit(*p) && p - *at < most; p++)
        sum = sum * 10 + (uint64_t)(*p - '0');
    const int count = (int)(p - *at);
    *value = sum;
    *at = p;
    return count;
}

bool obj_number(const char **at, float *number)
{
    static const double tenth[FRACTION_MAX + 1] = {0.0,  1e-1, 1e-2,  1e-3,  1e-4,  1e-5,  1e-6,  1e-7,
                                                   1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15};
    const char *p = *at;
    const bool minus = *p == '-';
    uint64_t integer, fraction, exponent;
    if (*p == '.') /* assimp refuses .5, but not +.5 */
        return false;
    p += minus || *p == '+';
    const int before = digits(&p, INTEGER_MAX, &integer);
    if (is_digit(*p))
        return false;
    float value = (float)integer;
    int after = 0;
    if (*p == '.') {
        p++;
        after = digits(&p, FRACTION_MAX, &fraction);
        while (is_digit(*p))
            p++;
        if (after > 0)
            value += (float)((double)fraction * tenth[after]);
    }
    if (before == 0 && after == 0)
        return false;
    if (*p == 'e' || *p == 'E') {
        p++;
        const bool negative = *p == '-';
        p += negative || *p == '+';
        if (digits(&p, EXPONENT_MAX, &exponent) == 0 || is_digit(*p))
            return false;
        value *= powf(10.0F, negative ? -(float)exponent : (float)exponent);
    }
    *number = minus ? -value : value;
    *at = p;
    return true;
}

bool obj_index(const char **at, uint32_t *index)
{
    uint64_t value;
    if (digits(at, 9, &value) == 0 || is_digit(**at) || value == 0)
        return false;
    *index = (uint32_t)value;
    return true;
}

/* --- statements --- */

#define ROOM_FOR_ONE(o, array, room, count) ((o)->count < (o)->room || GROW((o)->array, (o)->room, (o)->count + 1))

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

/* Moves past blanks; false if there are none. */
static bool skip_blanks(const char **at)
{
    const char *p = *at;
    while (is_blank(*p))
        p++;
    const bool some = p > *at;
    *at = p;
    return some;
}

/* Moves past the end of the line; false if something precedes it. */
static bool end_line(const char **at)
{
    skip_blanks(at);
    *at += **at == '\r';
    return *(*at)++ == '\n';
}

/* Reads `count` numbers and the end of the line. */
static bool read_numbers(const char **at, int count, float *numbers)
{
    for (int i = 0; i < count; i++)
        if (!skip_blanks(at) || !obj_number(at, &numbers[i]))
            return false;
    return end_line(at);
}

/* Reads a corner: place, place/uv, place//normal or place/uv/normal. */
static bool read_corner(const char **at, obj_corner *corner)
{
    *corner = (obj_corner){0, 0, 0};
    if (!obj_index(at, &corner->place))
        return false;
    if (**at != '/')
        return true;
    (*at)++;
    if (**at != '/' && !obj_index(at, &corner->uv))
        return false;
    if (**at != '/')
        return true;
    (*at)++;
    return obj_index(at, &corner->normal);
}

/* Reads a triangle. Polygons, and faces whose corners differ in form, are left to assimp. */
static bool read_face(const char **at, obj_corner triangle[3])
{
    for (int k = 0; k < 3; k++) {
        if (!skip_blanks(at) || !read_corner(at, &triangle[k]))
            return false;
        if (!triangle[k].uv != !triangle[0].uv || !triangle[k].normal != !triangle[0].normal)
            return false;
    }
    return end_line(at);
}

static uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

static bool add_face(obj_part *o, const char **at)
{
    if (!ROOM_FOR_ONE(o, triangles, triangle_room, triangle_count) || !read_face(at, o->triangles[o->triangle_count]))
        return false;
    if (o->run_count == 0 || o->runs[o->run_count - 1].text_end != o->text_length) {
        if (!GROW(o->runs, o->run_room, o->run_count + 1))
            return false;
        o->runs[o->run_count++] = (obj_run){o->triangle_count, 0, o->text_length};
    }
    o->runs[o->run_count - 1].count++;
    const obj_corner *corner = o->triangles[o->triangle_count++];
    o->early = o->early || (corner->uv > 0 && o->uv_count == 0);
    for (int k = 0; k < 3; k++)
        o->highest = (obj_corner){larger(o->highest.place, corner[k].place), larger(o->highest.uv, corner[k].uv),
                                  larger(o->highest.normal, corner[k].normal)};
    return true;
}

static bool starts_with(const char *line, size_t length, const char *word)
{
    const size_t n = strlen(word);
    return length >= n && memcmp(line, word, n) == 0 && (length == n || is_blank(line[n]));
}

/* Skips a comment; copies a statement on groups or materials to the part's text. False: any other statement. */
static bool read_text(obj_part *o, const char **at)
{
    static const char *const keywords[] = {"o", "g", "s", "usemtl", "mtllib"};
    const char *line = *at, *end = memchr(line, '\n', (size_t)(o->end - line));
    size_t length = (size_t)(end - line);
    length -= length > 0 && line[length - 1] == '\r';
    *at = end + 1;
    if (length == 0)
        return true;
    if (line[length - 1] == '\\' || memchr(line, 0, length) || memchr(line, '\r', length)) /* \ continues a line */
        return false;
    if (line[0] == '#')
        return true;
    bool known = false;
    for (size_t i = 0; i < sizeof keywords / sizeof *keywords; i++)
        known |= starts_with(line, length, keywords[i]);
    if (!known || !GROW(o->text, o->text_room, o->text_length + length + 1))
        return false;
    memcpy(o->text + o->text_length, line, length);
    o->text[o->text_length + length] = '\n';
    o->text_length += length + 1;
    return true;
}

static bool read_line(obj_part *o, const char **at)
{
    const char *p = *at;
    if (p[0] == 'v' && is_blank(p[1])) {
        *at = p + 1;
        return ROOM_FOR_ONE(o, places, place_room, place_count) && read_numbers(at, 3, o->places[o->place_count++]);
    }
    if (p[0] == 'f' && is_blank(p[1])) {
        *at = p + 1;
        return add_face(o, at);
    }
    if (p[0] == 'v' && p[1] == 't' && is_blank(p[2])) {
        *at = p + 2;
        return ROOM_FOR_ONE(o, uvs, uv_room, uv_count) && read_numbers(at, 2, o->uvs[o->uv_count++]);
    }
    if (p[0] == 'v' && p[1] == 'n' && is_blank(p[2])) {
        *at = p + 2;
        return ROOM_FOR_ONE(o, normals, normal_room, normal_count) &&
               read_numbers(at, 3, o->normals[o->normal_count++]);
    }
    return read_text(o, at);
}

void obj_parse(obj_part *o)
{
    o->plain = true;
    for (const char *at = o->begin; at < o->end && o->plain;) {
        const char *line = at;
        o->plain = read_line(o, &at) && at - line <= OBJ_LINE_MAX;
    }
}
