/* A report on this machine for measurements: processors, clocks, vector instruction sets, and current disturbances.
 * Ownership: machine_measure allocates, machine_release frees, also after an error. */
#pragma once

#include "base/isa.h"
#include "base/status.h"
#include "measure/clock.h"
#include "measure/topology.h"
#include <jansson.h>
#include <stdbool.h>
#include <sys/utsname.h>

typedef struct machine_report {
    topology *machine;
    isa best, chosen;
    clock_quality wall, cpu;
    struct utsname kernel;
    bool has_hardware_counters;
    json_t *disturbances; /* list of texts */
} machine_report;

/* Takes half a second to measure the load of other processes. STATUS_BAD_INPUT for an invalid instruction set in the
 * environment (CUVETTE_ISA). */
status machine_measure(machine_report *a, diagnostic *why);
void machine_release(machine_report *a);

/* The output of `cuvette machine --json`; NULL when out of memory. */
json_t *machine_json(const machine_report *a);
