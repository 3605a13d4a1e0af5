/* One kept message for each rank. */
#include "simulated_mpi.h"

#include <stdlib.h>
#include <string.h>

/* No simulated rank is another thread: they are one process and take turns, and each finds its own by its number. */
enum { RANKS_MOST = 1 << 14, MESSAGE_MOST = 1 << 22 };

typedef struct kept_message {
    char *bytes; /* NULL: none */
    MPI_Status status;
} kept_message;

static kept_message kept[RANKS_MOST];

static kept_message *own(void)
{
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return &kept[rank];
}

void keep_next_message(void)
{
    kept_message *k = own();
    MPI_Request request;
    if (!(k->bytes = malloc(MESSAGE_MOST))) /* what is not written takes no pages */
        MPI_Abort(MPI_COMM_WORLD, 1);
    MPI_Irecv(k->bytes, MESSAGE_MOST, MPI_BYTE, MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &request);
    MPI_Wait(&request, &k->status);
}

int kept_iprobe(int source, int tag, MPI_Comm comm, int *there, MPI_Status *status)
{
    const kept_message *k = own();
    if (!k->bytes)
        return MPI_Iprobe(source, tag, comm, there, status);
    *status = k->status;
    *there = 1;
    return MPI_SUCCESS;
}

int kept_recv(void *bytes, int size, MPI_Datatype type, int source, int tag, MPI_Comm comm, MPI_Status *status)
{
    kept_message *k = own();
    if (!k->bytes)
        return MPI_Recv(bytes, size, type, source, tag, comm, status);
    int count = 0;
    MPI_Get_count(&k->status, type, &count);
    memcpy(bytes, k->bytes, (size_t)(count < size ? count : size));
    free(k->bytes);
    k->bytes = NULL;
    return MPI_SUCCESS;
}
