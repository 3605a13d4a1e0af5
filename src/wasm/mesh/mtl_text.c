/* Material libraries of OBJ files: newmtl, Kd, Ka, Ks, Ke, Ns, Ni, d, Tr, map_Kd; the rest is ignored. */
#include "wasm/mesh/lines.h"
#include "wasm/mesh/mesh.h"

#include "base/file.h"
#include <stdlib.h>
#include <string.h>

enum { MTL_BYTES_MAX = 1 << 24 };

/* One number is a grey. */
static void take_color(lines *l, double color[3])
{
    float v[3];
    const int count = lines_numbers(l, 3, v);
    for (int k = 0; k < 3 && count > 0; k++)
        color[k] = (double)v[count == 3 ? k : 0];
}

static void take_number(lines *l, double *number)
{
    float v;
    if (lines_numbers(l, 1, &v) == 1)
        *number = (double)v;
}

/* The name is what follows the options, which begin with -. */
static status take_texture(lines *l, mesh_material *m, diagnostic *why)
{
    const char *name;
    size_t length = lines_rest(l, &name);
    for (size_t i = length; *name == '-' && i > 0; i--)
        if (name[i - 1] == ' ' || name[i - 1] == '\t') {
            length -= i;
            name += i;
            break;
        }
    if (length == 0)
        return STATUS_OK;
    free(m->texture);
    m->texture = strndup(name, length);
    return m->texture ? STATUS_OK : out_of_memory(why);
}

static status take_line(lines *l, mesh_parts *p, size_t *current, diagnostic *why)
{
    const char *word, *rest;
    size_t length;
    if (!lines_word(l, &word, &length) || *word == '#')
        return STATUS_OK;
    if (lines_is(word, length, "newmtl")) {
        const size_t size = lines_rest(l, &rest);
        for (size_t i = 1; i < p->material_count; i++)
            if (lines_is(rest, size, p->materials[i].name)) {
                *current = i;
                return STATUS_OK;
            }
        return mesh_parts_material(p, rest, size, current, why);
    }
    if (*current == 0)
        return STATUS_OK;
    mesh_material *m = &p->materials[*current];
    if (lines_is(word, length, "Kd"))
        take_color(l, m->values.diffuse);
    else if (lines_is(word, length, "Ka"))
        take_color(l, m->values.ambient);
    else if (lines_is(word, length, "Ks"))
        take_color(l, m->values.specular);
    else if (lines_is(word, length, "Ke"))
        take_color(l, m->values.emissive);
    else if (lines_is(word, length, "Ns"))
        take_number(l, &m->values.shininess);
    else if (lines_is(word, length, "Ni"))
        take_number(l, &m->values.ior);
    else if (lines_is(word, length, "d"))
        take_number(l, &m->values.opacity);
    else if (lines_is(word, length, "map_Kd"))
        return take_texture(l, m, why);
    else if (lines_is(word, length, "Tr")) {
        float clear;
        if (lines_numbers(l, 1, &clear) == 1)
            m->values.opacity = (double)(1.0F - clear);
    }
    return STATUS_OK;
}

status mtl_read(const char *path, const char *root, mesh_parts *p, diagnostic *why)
{
    char *text = NULL;
    size_t size = 0, current = 0;
    TRY(file_read_below(path, root, MTL_BYTES_MAX, &text, &size, why));
    lines l = {.at = text, .end = text + size};
    status code = STATUS_OK;
    while (code == STATUS_OK && lines_next(&l))
        code = take_line(&l, p, &current, why);
    free(text);
    return code;
}
