/* Lets in a few at a time, for what takes much memory and time and cannot be ended on its way: pictures that are
 * encoded or compared, models that are read. For any number of threads. Ownership: gate_create gives, gate_destroy
 * releases, when nobody is in it or waits. */
#pragma once

#include "base/status.h"

typedef struct gate gate;

gate *gate_create(int places); /* NULL when memory is out */
void gate_destroy(gate *g);    /* NULL is allowed */

/* Waits for a place. STATUS_INTERRUPTED, and no place, where the gate is closed before there is one. */
status gate_enter(gate *g, diagnostic *why);
void gate_leave(gate *g);
/* For good: who waits is sent away, who is in goes on. */
void gate_close(gate *g);
