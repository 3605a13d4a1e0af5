/* What this machine is, as far as it matters to a measurement: processors, clocks, vector instructions, and what could
 * disturb now. Ownership: machine_measure fills, machine_release releases, also after an error. */
#pragma once

#include "base/isa.h"
#include "base/status.h"
#include "measure/clock.h"
#include "measure/topology.h"
#include <jansson.h>
#include <stdbool.h>
#include <sys/utsname.h>

typedef struct machine_account {
    topology *machine;
    isa best, chosen;
    clock_quality wall, cpu;
    struct utsname kernel;
    bool has_hardware_counters;
    json_t *disturbances; /* list of texts */
} machine_account;

/* Takes half a second, in which it watches the load of others. An instruction set that the environment asks for wrongly
 * is STATUS_BAD_INPUT. */
status machine_measure(machine_account *a, diagnostic *why);
void machine_release(machine_account *a);

/* What `cuvette machine --json` prints; NULL when memory is out. */
json_t *machine_json(const machine_account *a);
