/* Broadcasts in parts. */
#include "mpi/broadcast.h"

#include <mpi.h>

void broadcast(void *bytes, size_t size)
{
    const size_t part = (size_t)1 << 30;
    for (size_t at = 0; at < size; at += part)
        MPI_Bcast((char *)bytes + at, (int)(size - at < part ? size - at : part), MPI_BYTE, 0, MPI_COMM_WORLD);
}
