/* Bytes of any number from rank 0 to all others, in parts that MPI's 32-bit counts hold. All ranks call it. */
#pragma once

#include <stddef.h>

void broadcast(void *bytes, size_t size);
