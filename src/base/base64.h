/* Base64 (RFC 4648) of data in documents, and base64url without padding for addresses. Ownership: results are the
 * caller's, freed with free. */
#pragma once

#include <stddef.h>
#include <stdbool.h>

/* NULL when out of memory. for_address: base64url without padding. */
char *base64_encode(const void *bytes, size_t size, bool for_address);

/* Decodes base64url without padding. NULL for another character, an impossible length, or when out of memory. */
unsigned char *base64_decode(const char *text, size_t length, size_t *size);
