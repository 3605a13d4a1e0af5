/* Reads the material libraries of OBJ files: newmtl, Kd, Ka, Ks, Ke, Ns, Ni, d, Tr, map_Kd, map_d. Other statements are
 * ignored: they are extensions, or nothing here depends on them.
 *
 * MTL has no mode of alpha. Programs write map_d where an image's alpha counts, nearly always with the name of map_Kd:
 * then the material is blended. An image of map_Kd alone is opaque, whatever alpha it has: many exporters leave some in
 * images that are not meant to be clear. */
#include "base/array.h"
#include "base/file.h"
#include "import/plain.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum { MATERIALS_MAX = 65536 };

typedef struct library {
    const request *req;
    const char *name; /* as in the mesh file */
    lines text;
    mtl_library *into;
    bool d_given; /* for the last material */
    flat_mesh *flat;
    diagnostic *why;
} library;

static status bad(const library *l, const char *remedy, const char *keyword, const char *word, size_t length)
{
    return diagnose(l->why, STATUS_BAD_INPUT, remedy, "needs the file '%.200s', where in line %ld %s has '%.*s'",
                    l->name, l->text.line, keyword, length < 60 ? (int)length : 60, word);
}

/* Reads up to three numbers; returns STATUS_OK with *count = 0 if the first word is a name ("spectral", "xyz"). */
static status read_numbers(library *l, const char *keyword, double v[3], int *count)
{
    const char *word;
    size_t length;
    for (*count = 0; *count < 3 && lines_word(&l->text, &word, &length) && *word != '#'; ++*count) {
        if (*count == 0 && (lines_is(word, length, "spectral") || lines_is(word, length, "xyz")))
            return STATUS_OK;
        if (*count == 0 && lines_is(word, length, "-halo") && !lines_word(&l->text, &word, &length))
            return STATUS_OK;
        if (!lines_number(word, length, &v[*count]))
            return bad(l, "give a finite number", keyword, word, length);
    }
    return STATUS_OK;
}

/* Reads a colour; a single number is a grey. */
static status read_color(library *l, const char *keyword, double color[3])
{
    double v[3];
    int count;
    TRY(read_numbers(l, keyword, v, &count));
    for (int k = 0; k < 3 && count > 0; k++)
        color[k] = v[count == 3 ? k : 0];
    return STATUS_OK;
}

static status read_number(library *l, const char *keyword, double *number)
{
    double v[3];
    int count;
    TRY(read_numbers(l, keyword, v, &count));
    *number = count > 0 ? v[0] : *number;
    return STATUS_OK;
}

/* Skips the values of an option of map_Kd, map_Ke or map_d, of which the last may be missing if they are numbers.
 * False: no option. */
static bool skip_option(library *l, const char *keyword, const char *word, size_t length)
{
    static const struct {
        const char *name;
        int least, most;
    } options[] = {{"-blendu", 1, 1}, {"-blendv", 1, 1}, {"-cc", 1, 1}, {"-clamp", 1, 1},  {"-imfchan", 1, 1},
                   {"-boost", 1, 1},  {"-bm", 1, 1},     {"-mm", 2, 2}, {"-texres", 1, 1}, {"-type", 1, 1},
                   {"-o", 1, 3},      {"-s", 1, 3},      {"-t", 1, 3}};
    for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
        if (!lines_is(word, length, options[i].name))
            continue;
        double unused;
        const char *value;
        for (int k = 0; k < options[i].most; k++) {
            const char *before = l->text.at;
            size_t size;
            if (!lines_word(&l->text, &value, &size) ||
                (k >= options[i].least && !lines_number(value, size, &unused))) {
                l->text.at = before;
                break;
            }
        }
        if (options[i].most == 3 || lines_is(word, length, "-mm"))
            flat_note(l->flat, "the option %.*s of %s in '%.100s' is ignored", (int)length, word, keyword, l->name);
        return true;
    }
    return false;
}

/* Reads the name of an image, which may have blanks, after its options. */
static status read_texture(library *l, const char *keyword, char **image)
{
    for (;;) {
        const char *before = l->text.at, *word;
        size_t length;
        if (lines_word(&l->text, &word, &length) && skip_option(l, keyword, word, length))
            continue;
        l->text.at = before;
        break;
    }
    const char *name;
    const size_t length = lines_rest(&l->text, &name);
    if (length == 0)
        return STATUS_OK;
    free(*image);
    *image = strndup(name, length);
    return *image ? STATUS_OK : no_memory_for(l->req, l->why);
}

static mesh_material default_material(void)
{
    return (mesh_material){.values = {.diffuse = {0.6, 0.6, 0.6}, .opacity = 1, .ior = 1, .flags = MESH_WIRE_GIVEN}};
}

/* Ends a material, once all its statements have been read: decides on alpha. Programs that mean the opacity by Tr write
 * Tr 1 for what is opaque, and nobody gives an image to what cannot be seen. */
static void end_material(library *l, mesh_material *m)
{
    if (m->texture && m->values.opacity == 0 && !l->d_given) {
        m->values.opacity = 1;
        flat_note(l->flat, "Tr 1 of material '%.100s' is taken for opaque, as some programs mean it", m->name);
    }
    if (m->cover && m->texture && strcmp(m->cover, m->texture) == 0)
        m->values.alpha_mode = MESH_WIRE_ALPHA_BLEND;
    else if (m->cover)
        flat_note(l->flat, "map_d of the material '%.100s' is not read: only the alpha of the image of map_Kd is",
                  m->name);
    free(m->cover);
    m->cover = NULL;
    double *sent = m->values.emissive;
    if (m->glow && sent[0] == 0 && sent[1] == 0 && sent[2] == 0)
        sent[0] = sent[1] = sent[2] = 1; /* nobody gives an image to what cannot be seen */
}

static status new_material(library *l)
{
    const char *name;
    const size_t length = lines_rest(&l->text, &name);
    mtl_library *m = l->into;
    if (m->count == MATERIALS_MAX)
        return diagnose(l->why, STATUS_BAD_INPUT, "remove unused materials",
                        "needs the file '%.200s', which has more than %d materials", l->name, (int)MATERIALS_MAX);
    if (!GROW(m->list, m->room, m->count + 1))
        return no_memory_for(l->req, l->why);
    m->list[m->count] = default_material();
    l->d_given = false;
    m->list[m->count].name = strndup(name, length);
    return m->list[m->count++].name ? STATUS_OK : no_memory_for(l->req, l->why);
}

static status read_statement(library *l, const char *word, size_t length, mesh_material *m)
{
    mesh_wire_material *v = &m->values;
    if (lines_is(word, length, "Kd"))
        return read_color(l, "Kd", v->diffuse);
    if (lines_is(word, length, "Ka"))
        return read_color(l, "Ka", v->ambient);
    if (lines_is(word, length, "Ks"))
        return read_color(l, "Ks", v->specular);
    if (lines_is(word, length, "Ke"))
        return read_color(l, "Ke", v->emissive);
    if (lines_is(word, length, "Ns"))
        return read_number(l, "Ns", &v->shininess);
    if (lines_is(word, length, "Ni"))
        return read_number(l, "Ni", &v->ior);
    l->d_given |= lines_is(word, length, "d");
    if (lines_is(word, length, "d"))
        return read_number(l, "d", &v->opacity);
    if (lines_is(word, length, "map_Kd"))
        return read_texture(l, "map_Kd", &m->texture);
    if (lines_is(word, length, "map_d"))
        return read_texture(l, "map_d", &m->cover);
    if (lines_is(word, length, "map_Ke"))
        return read_texture(l, "map_Ke", &m->glow);
    if (lines_is(word, length, "Tr")) {
        double clear = 1 - v->opacity;
        TRY(read_number(l, "Tr", &clear));
        v->opacity = 1 - clear;
    }
    return STATUS_OK;
}

static status read_text(library *l)
{
    const char *word;
    size_t length;
    const size_t first = l->into->count;
    do {
        if (!lines_word(&l->text, &word, &length))
            continue;
        const bool begun = l->into->count > first;
        if (lines_is(word, length, "newmtl")) {
            if (begun)
                end_material(l, &l->into->list[l->into->count - 1]);
            TRY(new_material(l));
        } else if (begun) {
            TRY(read_statement(l, word, length, &l->into->list[l->into->count - 1]));
        }
    } while (lines_next(&l->text));
    if (l->into->count > first)
        end_material(l, &l->into->list[l->into->count - 1]);
    return STATUS_OK;
}

/* Opens a file next to the mesh file; a name with \ is tried with / if there is no such file. */
static int open_library(library *l, const char **reason)
{
    int fd = files_open_beside(l->req, l->name, reason);
    if (fd >= 0 || errno != ENOENT || !strchr(l->name, '\\'))
        return fd;
    char *other = strdup(l->name);
    for (char *c = other; other && *c; c++)
        *c = *c == '\\' ? '/' : *c;
    errno = ENOMEM;
    fd = other ? files_open_beside(l->req, other, reason) : -1;
    const int error = errno;
    free(other);
    errno = error;
    return fd;
}

static status read_library(library *l, bool *missing)
{
    const char *reason = "";
    const int fd = open_library(l, &reason);
    *missing = fd < 0 && (errno == ENOENT || errno == ENOTDIR);
    if (*missing)
        return STATUS_OK;
    if (fd < 0 && errno == ENOMEM)
        return no_memory_for(l->req, l->why);
    if (fd < 0 && errno == EXDEV)
        return diagnose(l->why, STATUS_BAD_INPUT, BELOW_REMEDY, "needs the file '%.200s', which %s", l->name, reason);
    if (fd < 0)
        return diagnose(l->why, STATUS_BAD_INPUT,
                        "put this file where the mesh file expects it, or remove the line that names it",
                        "needs the file '%.200s': %s", l->name, reason);
    file_text text;
    diagnostic fault = {0};
    status code = files_read(l->req, fd, FILE_MTL, &text, &fault);
    if (code != STATUS_OK)
        return diagnose(l->why, code, fault.remedy, "needs the file '%.200s': %.300s", l->name, fault.what);
    l->text = lines_of(text.bytes, text.size);
    code = read_text(l);
    files_release(&text);
    return code;
}

/* Reads the library with a name; false in *found if there is none. */
static status read_named(library *l, const char *name, size_t length, bool *found)
{
    bool missing = false;
    char *copy = strndup(name, length);
    l->name = copy;
    const status code = copy ? read_library(l, &missing) : no_memory_for(l->req, l->why);
    free(copy);
    *found = !missing;
    return code;
}

status mtl_read(const request *req, const char *names, size_t length, mtl_library *into, flat_mesh *flat,
                diagnostic *why)
{
    library l = {.req = req, .into = into, .flat = flat, .why = why};
    lines words = lines_of(names, length);
    const char *word;
    bool found = true;
    if (length == 0)
        return STATUS_OK;
    TRY(read_named(&l, names, length, &found));
    if (found)
        return STATUS_OK;
    for (size_t size; lines_word(&words, &word, &size);) {
        if (size < length)
            TRY(read_named(&l, word, size, &found));
        if (!found)
            flat_note(flat, "the material library '%.*s' does not exist: its materials are grey",
                      size < 200 ? (int)size : 200, word);
    }
    return STATUS_OK;
}

void mtl_release(mtl_library *m)
{
    for (size_t i = 0; i < m->count; i++)
        free(m->list[i].name), free(m->list[i].texture), free(m->list[i].glow), free(m->list[i].cover);
    free(m->list);
    *m = (mtl_library){0};
}

mesh_material mtl_find(const mtl_library *m, const char *name, size_t length)
{
    for (size_t i = 0; i < m->count; i++)
        if (strlen(m->list[i].name) == length && memcmp(m->list[i].name, name, length) == 0)
            return m->list[i];
    return default_material();
}
