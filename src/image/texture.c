/* Textures: memory, mipmap, creation, reading, ownership, hash, packing. */
#include "image/texture.h"

#include "base/array.h"
#include "base/budget.h"
#include "base/cancel.h"
#include "base/hash.h"
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* ---- memory ---- */

/* Sets the sizes of all levels and allocates their memory. */
static bool allocate_levels(texture *t, int width, int height)
{
    size_t count = 0, start[TEXTURE_LEVELS_MAX];
    do {
        t->level[t->levels] = (texture_level){.width = width, .height = height};
        start[t->levels++] = count;
        count += (size_t)width * (size_t)height;
        if (width == 1 && height == 1)
            break;
        width = width > 1 ? width / 2 : 1;
        height = height > 1 ? height / 2 : 1;
    } while (t->filter == TEXTURE_TRILINEAR);
    t->block_bytes = (count * sizeof(texel) + 63) / 64 * 64;
    t->block = large_pages(aligned_alloc(64, t->block_bytes), t->block_bytes);
    for (int level = 0; t->block && level < t->levels; level++)
        t->level[level].texels = t->block + start[level];
    return t->block;
}

/* A texture with memory for its texels, which are not set; NULL if memory runs out. Sides are at least 1. */
static texture *allocate_texture(int width, int height, texture_wrap wrap_u, texture_wrap wrap_v, texture_filter filter)
{
    texture *t = malloc(sizeof *t);
    if (t)
        *t = (texture){.wrap_u = wrap_u, .wrap_v = wrap_v, .filter = filter, .owners = 1};
    if (t && !allocate_levels(t, width, height)) {
        free(t);
        return NULL;
    }
    return t;
}

void texture_retain(const texture *t)
{
    __atomic_add_fetch(&((texture *)t)->owners, 1, __ATOMIC_RELAXED);
}

void texture_release(const texture *t)
{
    if (t && __atomic_sub_fetch(&((texture *)t)->owners, 1, __ATOMIC_ACQ_REL) == 0) {
        texture_release(t->covered);
        free(t->block);
        free((texture *)t);
    }
}

/* ---- the mipmap ---- */

/* Each level is the box filter of the one before, with the exact area fractions of texels if a side is odd (Guthe and
 * Heckbert, "Non-power-of-two mipmap creation", NVIDIA TR-01838-001, 2005). */

/* The texels of a row of `from` that one texel of the next smaller row covers, and their weights: a texel of the
 * smaller row is n/m = 2 + 1/m texels wide if n = 2m + 1. */
typedef struct cover {
    int first, count;
    double weight[3];
} cover;

static cover cover_of(int texel_index, int from, int to)
{
    if (from == to)
        return (cover){.first = texel_index, .count = 1, .weight = {1.0, 0.0, 0.0}};
    if (from % 2 == 0)
        return (cover){.first = 2 * texel_index, .count = 2, .weight = {0.5, 0.5, 0.0}};
    double n = from;
    return (cover){
        .first = 2 * texel_index, .count = 3, .weight = {(to - texel_index) / n, to / n, (texel_index + 1) / n}};
}

static texel mean_of(const texture_level *from, cover columns, cover rows)
{
    double r = 0.0, g = 0.0, b = 0.0, alpha = 0.0;
    for (int y = 0; y < rows.count; y++) {
        const texel *row = from->texels + (size_t)(rows.first + y) * (size_t)from->width + columns.first;
        for (int x = 0; x < columns.count; x++) {
            double weight = rows.weight[y] * columns.weight[x];
            r += weight * (double)row[x].r;
            g += weight * (double)row[x].g;
            b += weight * (double)row[x].b;
            alpha += weight * (double)row[x].alpha;
        }
    }
    return (texel){.r = (float)r, .g = (float)g, .b = (float)b, .alpha = (float)alpha};
}

/* Computes level 1 and above from level 0; sizes and memory are set. */
static void build_pyramid(texture *t)
{
    for (int level = 1; level < t->levels; level++) {
        const texture_level *from = &t->level[level - 1], *to = &t->level[level];
        for (int y = 0; y < to->height && !cancel_asked(); y++) {
            cover rows = cover_of(y, from->height, to->height);
            for (int x = 0; x < to->width; x++)
                to->texels[(size_t)y * (size_t)to->width + (size_t)x] =
                    mean_of(from, cover_of(x, from->width, to->width), rows);
        }
    }
}

/* ---- alpha ---- */

static size_t texels_of(const texture *t)
{
    return (size_t)t->level[0].width * (size_t)t->level[0].height;
}

static bool has_alpha(const texture *t)
{
    bool any = false;
    for (size_t i = 0; i < texels_of(t); i++)
        any |= t->block[i].alpha < 1.0F;
    return any;
}

static texel multiplied(texel c)
{
    return (texel){.r = c.r * c.alpha, .g = c.g * c.alpha, .b = c.b * c.alpha, .alpha = c.alpha};
}

/* Computes the levels of a texture whose image is complete, and its covered texture if it has alpha. */
static status complete(texture *t, diagnostic *why)
{
    const int width = t->level[0].width, height = t->level[0].height;
    build_pyramid(t);
    if (!has_alpha(t))
        return cancel_check(why);
    TRY(memory_budget_check(t->block_bytes, "use a smaller one", why, "the alpha of %d x %d texels", width, height));
    t->covered = allocate_texture(width, height, t->wrap_u, t->wrap_v, t->filter);
    if (!t->covered)
        return out_of_memory(why);
    t->covered->multiplied = true;
    for (size_t i = 0; i < texels_of(t); i++)
        t->covered->block[i] = multiplied(t->block[i]);
    build_pyramid(t->covered);
    return cancel_check(why);
}

const char *texture_note(const texture *t)
{
    return t->note;
}

void texture_size(const texture *t, int *width, int *height)
{
    *width = t->level[0].width;
    *height = t->level[0].height;
}

const texture *texture_covered(const texture *t)
{
    return t->covered;
}

/* ---- creation ---- */

static status check_size(const image *img, diagnostic *why)
{
    if (img->width < 1 || img->height < 1 || img->width > IMAGE_SIDE_MAX || img->height > IMAGE_SIDE_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use a width and height of 1 to 65536",
                        "a texture cannot have %d x %d texels", img->width, img->height);
    return STATUS_OK;
}

/* Small negative values are noise: image_check_light. */
static float not_negative(float value)
{
    return value < 0.0F ? 0.0F : value;
}

/* Copies the image to level 0, whose rows begin at the bottom. */
static void copy_pixels(texture *t, const image *img)
{
    const texture_level *to = &t->level[0];
    for (int y = 0; y < to->height && !cancel_asked(); y++) {
        const size_t first = (size_t)(to->height - 1 - y) * (size_t)to->width;
        const float *from = img->pixel + 3 * first;
        texel *row = to->texels + (size_t)y * (size_t)to->width;
        for (int x = 0; x < to->width; x++, from += 3) {
            row[x] = (texel){.r = not_negative(from[0]),
                             .g = not_negative(from[1]),
                             .b = not_negative(from[2]),
                             .alpha = img->alpha ? img->alpha[first + (size_t)x] : 1.0F};
        }
    }
}

status texture_create(const image *img, texture_wrap wrap_u, texture_wrap wrap_v, texture_filter filter, texture **out,
                      diagnostic *why)
{
    char note[IMAGE_NOTE_MAX];
    *out = NULL;
    memcpy(note, img->note, sizeof note);
    TRY(check_size(img, why));
    TRY(image_check_light(img, note, NULL, why));
    const uint64_t texels = (uint64_t)img->width * (uint64_t)img->height;
    TRY(memory_budget_check((filter == TEXTURE_TRILINEAR ? texels / 3 * 4 : texels) * sizeof(texel),
                            "use a smaller one", why, "a texture of %d x %d texels", img->width, img->height));
    texture *t = allocate_texture(img->width, img->height, wrap_u, wrap_v, filter);
    if (!t)
        return diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory for a texture of %d x %d texels", img->width,
                        img->height);
    memcpy(t->note, note, sizeof t->note);
    copy_pixels(t, img);
    const status code = complete(t, why);
    if (code == STATUS_OK)
        *out = t;
    else
        texture_release(t);
    return code;
}

static image_values values_of(texture_space space)
{
    return space == TEXTURE_LINEAR ? IMAGE_CODED : space == TEXTURE_GLTF ? IMAGE_SRGB : IMAGE_LIGHT;
}

status texture_read_below(const char *path, const char *root, texture_space space, texture_wrap wrap_u,
                          texture_wrap wrap_v, texture_filter filter, texture **out, diagnostic *why)
{
    image *img;
    *out = NULL;
    TRY(image_read_below(path, root, values_of(space), &img, NULL, why));
    status code = texture_create(img, wrap_u, wrap_v, filter, out, why);
    if (code != STATUS_OK)
        diagnostic_locate(why, path, 0, 0);
    image_destroy(img);
    return code;
}

status texture_decode(const void *bytes, size_t size, texture_space space, texture_wrap wrap_u, texture_wrap wrap_v,
                      texture_filter filter, texture **out, diagnostic *why)
{
    image *img;
    *out = NULL;
    TRY(image_decode(bytes, size, values_of(space), &img, NULL, why));
    const status code = texture_create(img, wrap_u, wrap_v, filter, out, why);
    image_destroy(img);
    return code;
}

/* ---- sampling and hash ---- */

vec3 texture_sample(const texture *t, double u, double v, double footprint)
{
    vec3 c = {1.0, 1.0, 1.0};
    ISA_BASE_OF(texture_tint)(t, 1, &u, &v, &footprint, &c.x, &c.y, &c.z);
    return c;
}

double texture_alpha(const texture *covered, double u, double v)
{
    return ISA_BASE_OF(texture_alpha)(covered, u, v);
}

uint64_t texture_hash(const texture *t, uint64_t hash)
{
    const texture_level *l = &t->level[0];
    const int64_t size[2] = {l->width, l->height};
    hash = hash_words(hash, size, 2);
    for (size_t i = 0; i < (size_t)l->width * (size_t)l->height; i++) {
        const float c[4] = {l->texels[i].r, l->texels[i].g, l->texels[i].b, l->texels[i].alpha};
        hash = hash_numbers(hash, c, t->covered ? 4 : 3, sizeof *c);
    }
    return hash;
}

uint64_t texture_sampler_hash(const texture *t, uint64_t hash)
{
    const int64_t sampler[] = {t->wrap_u, t->wrap_v, t->filter};
    const bool usual = t->wrap_u == TEXTURE_REPEAT && t->wrap_v == TEXTURE_REPEAT && t->filter == TEXTURE_TRILINEAR;
    return usual ? hash : hash_words(hash, sampler, 3);
}

/* ---- packing ---- */

typedef struct texture_head {
    int64_t width, height, wrap_u, wrap_v, filter;
} texture_head;

status texture_pack(const texture *t, pack_writer *to, diagnostic *why)
{
    const texture_head head = {t->level[0].width, t->level[0].height, t->wrap_u, t->wrap_v, t->filter};
    TRY(pack_put(to, &head, sizeof head, why));
    return pack_put(to, t->level[0].texels, texels_of(t) * sizeof(texel), why);
}

static status unpack_texels(texture *t, pack_reader *from, diagnostic *why)
{
    const texel *texels = t->level[0].texels;
    TRY(pack_get(from, t->level[0].texels, texels_of(t) * sizeof *texels, why));
    bool finite = true;
    for (size_t i = 0; i < texels_of(t); i++)
        finite &= isfinite(texels[i].r) && isfinite(texels[i].g) && isfinite(texels[i].b) && texels[i].alpha >= 0.0F &&
                  texels[i].alpha <= 1.0F;
    if (!finite)
        return pack_damaged(why, "a texel is not a finite number");
    return complete(t, why);
}

status texture_unpack(pack_reader *from, const texture **out, diagnostic *why)
{
    texture_head head;
    *out = NULL;
    TRY(pack_get(from, &head, sizeof head, why));
    const bool known = head.wrap_u >= TEXTURE_REPEAT && head.wrap_u <= TEXTURE_CLAMP && head.wrap_v >= TEXTURE_REPEAT &&
                       head.wrap_v <= TEXTURE_CLAMP && head.filter >= TEXTURE_NEAREST &&
                       head.filter <= TEXTURE_TRILINEAR;
    if (!known || !image_pack_holds(from, head.width, head.height, sizeof(texel)))
        return pack_damaged(why, "the size of a texture");
    texture *t = allocate_texture((int)head.width, (int)head.height, (texture_wrap)head.wrap_u,
                                  (texture_wrap)head.wrap_v, (texture_filter)head.filter);
    const status code = t ? unpack_texels(t, from, why) : out_of_memory(why);
    if (code != STATUS_OK) {
        texture_release(t);
        return code;
    }
    *out = t;
    return STATUS_OK;
}
