/* Images and textures as bytes (base/pack.h). Of a texture the image itself travels, and the receiver computes the
 * smaller levels again. What is read is checked: sizes, and that texels are finite; the values of an image are not.
 * Ownership: what is unpacked is the caller's. Errors: STATUS_BAD_INPUT for damaged bytes, STATUS_FAILURE without
 * memory. */
#pragma once

#include "base/pack.h"
#include "image/image.h"
#include "image/texture.h"

status image_pack(const image *img, pack_writer *to, diagnostic *why);
status image_unpack(pack_reader *from, image **out, diagnostic *why);

status texture_pack(const texture *t, pack_writer *to, diagnostic *why);
status texture_unpack(pack_reader *from, const texture **out, diagnostic *why);
