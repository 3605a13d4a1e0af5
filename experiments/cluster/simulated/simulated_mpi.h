/* Waiting for a message without polling. SimGrid's MPI_Probe polls, at the cost of one event for each look, so a rank
 * that waits receives the message instead and keeps it: mpi/messenger.c, which is compiled with this header before it,
 * then finds and receives the kept one as if it had just arrived. */
#pragma once

#include <mpi.h>
#include <stddef.h>

/* Waits for the next message to this rank and keeps it. */
void keep_next_message(void);

int kept_iprobe(int source, int tag, MPI_Comm comm, int *there, MPI_Status *status);
int kept_recv(void *bytes, int size, MPI_Datatype type, int source, int tag, MPI_Comm comm, MPI_Status *status);

#ifdef MESSAGES_ARE_KEPT
#undef MPI_Iprobe
#undef MPI_Recv
#define MPI_Iprobe kept_iprobe
#define MPI_Recv kept_recv
#endif
