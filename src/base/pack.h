/* Values and arrays as one sequence of bytes, from one process to another of the same build: in native byte order, as
 * they are in memory, each padded to words (8 bytes), and hashed on both sides. The reader does not trust what it
 * reads: it reads no more than the size of the sequence, so that callers can check a count before they allocate.
 *
 * A writer without a function only counts. The reader requests the same sizes in the same order as the writer wrote.
 * Ownership: both borrow the context; texts that are read are the caller's, released with free. Errors: those of
 * `write` and `read`; STATUS_BAD_INPUT for a sequence that is damaged or ends early. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stdint.h>

enum { PACK_WORD = 8 };

typedef status pack_write(void *context, const void *bytes, size_t size, diagnostic *why);
typedef status pack_read(void *context, void *bytes, size_t size, diagnostic *why);

/* Initialise to zeros, and the hash to HASH_START (base/hash.h). */
typedef struct pack_writer {
    pack_write *write; /* NULL: only counts */
    void *context;
    uint64_t size; /* bytes so far */
    uint64_t hash; /* of all words so far */
} pack_writer;

typedef struct pack_reader {
    pack_read *read;
    void *context;
    uint64_t left; /* bytes until the end */
    uint64_t hash;
} pack_reader;

status pack_put(pack_writer *w, const void *bytes, size_t size, diagnostic *why);
status pack_get(pack_reader *r, void *bytes, size_t size, diagnostic *why);

/* A text with its length; NULL is allowed. */
status pack_put_text(pack_writer *w, const char *text, diagnostic *why);
status pack_get_text(pack_reader *r, char **text, diagnostic *why);

/* Whether `count` more elements of `size` bytes fit into the rest of the sequence. */
bool pack_holds(const pack_reader *r, uint64_t count, size_t size);

/* STATUS_BAD_INPUT, with the reason. */
status pack_damaged(diagnostic *why, const char *what);
