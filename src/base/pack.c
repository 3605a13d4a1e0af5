/* Packing of values and arrays, padded to words and hashed. */
#include "base/pack.h"

#include "base/hash.h"
#include <stdlib.h>
#include <string.h>

/* Size in words of the buffer through which bytes are hashed, because they may be unaligned or not a multiple of
 * words. */
enum { HASHED = 512 };

static uint64_t hash_of(uint64_t hash, const void *bytes, size_t size)
{
    int64_t words[HASHED];
    for (size_t done = 0; done < size; done += sizeof words) {
        const size_t part = size - done < sizeof words ? size - done : sizeof words;
        const size_t count = (part + PACK_WORD - 1) / PACK_WORD;
        words[count - 1] = 0;
        memcpy(words, (const char *)bytes + done, part);
        hash = hash_words(hash, words, count);
    }
    return hash;
}

static size_t padding_of(size_t size)
{
    return (PACK_WORD - size % PACK_WORD) % PACK_WORD;
}

status pack_damaged(diagnostic *why, const char *what)
{
    return diagnose(why, STATUS_BAD_INPUT, "send it again", "the package is damaged: %s", what);
}

status pack_put(pack_writer *w, const void *bytes, size_t size, diagnostic *why)
{
    static const char zeros[PACK_WORD];
    const size_t padding = padding_of(size);
    w->size += size + padding;
    if (!w->write || size == 0)
        return STATUS_OK;
    w->hash = hash_of(w->hash, bytes, size);
    TRY(w->write(w->context, bytes, size, why));
    return padding ? w->write(w->context, zeros, padding, why) : STATUS_OK;
}

status pack_get(pack_reader *r, void *bytes, size_t size, diagnostic *why)
{
    char zeros[PACK_WORD] = {0};
    const size_t padding = padding_of(size);
    if (!pack_holds(r, 1, size) || r->left - size < padding)
        return pack_damaged(why, "it ends early");
    r->left -= size + padding;
    if (size == 0)
        return STATUS_OK;
    TRY(r->read(r->context, bytes, size, why));
    r->hash = hash_of(r->hash, bytes, size);
    if (padding)
        TRY(r->read(r->context, zeros, padding, why));
    return memcmp(zeros, (char[PACK_WORD]){0}, PACK_WORD) == 0 ? STATUS_OK
                                                               : pack_damaged(why, "the padding is not zero");
}

bool pack_holds(const pack_reader *r, uint64_t count, size_t size)
{
    return size == 0 || count <= r->left / size;
}

/* Writes the length plus one, or 0 for NULL, before the text. */
status pack_put_text(pack_writer *w, const char *text, diagnostic *why)
{
    const uint64_t length = text ? strlen(text) + 1 : 0;
    TRY(pack_put(w, &length, sizeof length, why));
    return length ? pack_put(w, text, length - 1, why) : STATUS_OK;
}

status pack_get_text(pack_reader *r, char **text, diagnostic *why)
{
    uint64_t length;
    *text = NULL;
    TRY(pack_get(r, &length, sizeof length, why));
    if (length == 0)
        return STATUS_OK;
    if (!pack_holds(r, length - 1, 1))
        return pack_damaged(why, "a text is too long");
    char *fresh = malloc(length);
    if (!fresh)
        return out_of_memory(why);
    status code = pack_get(r, fresh, length - 1, why);
    fresh[length - 1] = 0;
    if (code == STATUS_OK && strlen(fresh) != length - 1)
        code = pack_damaged(why, "a text contains a zero");
    if (code != STATUS_OK) {
        free(fresh);
        return code;
    }
    *text = fresh;
    return STATUS_OK;
}
