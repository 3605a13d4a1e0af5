#include "image/image_pack.h"

#include "image/texture_parts.h"
#include <math.h>
#include <stdlib.h>

typedef struct image_head {
    int64_t width, height, coded_bits;
} image_head;

typedef struct texture_head {
    int64_t width, height, wrap_u, wrap_v, filter;
} texture_head;

static bool is_side(int64_t length)
{
    return length >= 1 && length <= IMAGE_SIDE_MAX;
}

static bool holds(const pack_reader *from, int64_t width, int64_t height, size_t pixel)
{
    return is_side(width) && is_side(height) && pack_holds(from, (uint64_t)width * (uint64_t)height, pixel);
}

static size_t image_bytes(const image *img)
{
    return (size_t)img->width * (size_t)img->height * 3 * sizeof *img->pixel;
}

status image_pack(const image *img, pack_writer *to, diagnostic *why)
{
    const image_head head = {img->width, img->height, img->coded_bits};
    TRY(pack_put(to, &head, sizeof head, why));
    return pack_put(to, img->pixel, image_bytes(img), why);
}

status image_unpack(pack_reader *from, image **out, diagnostic *why)
{
    image_head head;
    *out = NULL;
    TRY(pack_get(from, &head, sizeof head, why));
    if (!holds(from, head.width, head.height, 3 * sizeof(float)) || head.coded_bits < 0 || head.coded_bits > 16)
        return pack_damaged(why, "the size of an image");
    TRY(image_create((int)head.width, (int)head.height, out, why));
    (*out)->coded_bits = (int)head.coded_bits;
    const status code = pack_get(from, (*out)->pixel, image_bytes(*out), why);
    if (code != STATUS_OK) {
        image_destroy(*out);
        *out = NULL;
    }
    return code;
}

static size_t texels_of(const texture *t)
{
    return (size_t)t->level[0].width * (size_t)t->level[0].height;
}

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
        finite &= isfinite(texels[i].r) && isfinite(texels[i].g) && isfinite(texels[i].b);
    if (!finite)
        return pack_damaged(why, "a texel is not a finite number");
    texture_build_pyramid(t);
    return STATUS_OK;
}

status texture_unpack(pack_reader *from, const texture **out, diagnostic *why)
{
    texture_head head;
    *out = NULL;
    TRY(pack_get(from, &head, sizeof head, why));
    const bool known = head.wrap_u >= TEXTURE_REPEAT && head.wrap_u <= TEXTURE_CLAMP && head.wrap_v >= TEXTURE_REPEAT &&
                       head.wrap_v <= TEXTURE_CLAMP && head.filter >= TEXTURE_NEAREST &&
                       head.filter <= TEXTURE_TRILINEAR;
    if (!known || !holds(from, head.width, head.height, sizeof(texel)))
        return pack_damaged(why, "the size of a texture");
    texture *t = texture_allocate((int)head.width, (int)head.height, (texture_wrap)head.wrap_u,
                                  (texture_wrap)head.wrap_v, (texture_filter)head.filter);
    const status code = t ? unpack_texels(t, from, why) : out_of_memory(why);
    if (code != STATUS_OK) {
        texture_release(t);
        return code;
    }
    *out = t;
    return STATUS_OK;
}
