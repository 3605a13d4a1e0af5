/* Bytes of any number from rank 0 to all others, in parts that MPI's 32-bit counts hold. All ranks call it. */
#pragma once

#include <mpi.h>
#include <stddef.h>

static inline void broadcast(void *bytes, size_t size)
{
    const size_t part = (size_t)1 << 30;
    for (size_t at = 0; at < size; at += part)
        MPI_Bcast((char *)bytes + at, (int)(size - at < part ? size - at : part), MPI_BYTE, 0, MPI_COMM_WORLD);
}
