/* The environment of a run: everything that times depend on, except the scene. Rows of unlike environments are never
 * pooled. The key is a hash of eight facts: the machine (a salted hash of its id), the processor's model and microcode,
 * SMT, the frequency governor, the limits of the control group and of the affinity mask, the instruction set, and the
 * build (base/installed.h). Fixed-size values; nothing to release. Unknown facts are "unknown". */
#pragma once

#include "base/isa.h"
#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>

enum { ENVIRONMENT_CPU_MODEL = 1, ENVIRONMENT_FACTS = 8, ENVIRONMENT_FACT_MAX = 120, ENVIRONMENT_KEY = 9 };

typedef struct run_environment {
    char fact[ENVIRONMENT_FACTS][ENVIRONMENT_FACT_MAX]; /* in the order of environment_names */
    char key[ENVIRONMENT_KEY];                          /* 8 hex digits */
} run_environment;

/* "machine", "cpu_model", "microcode", "smt", "governor", "limits", "isa", "build". */
extern const char *const environment_names[ENVIRONMENT_FACTS];

/* Reads the files of the system below root, "" for this machine. CUVETTE_MACHINE, if set, is part of the machine's
 * identity: it distinguishes machines that were cloned with the same id. CUVETTE_NODE_TYPE, if set, names a type that
 * replaces the machine, so that nodes of a cluster count as alike; the other facts still distinguish unlike nodes. A
 * fact that the system does not report is "unknown". STATUS_FAILURE if a file cannot be read now (memory, open files,
 * the disk): the key would name an environment that does not exist. */
status environment_read(const char *root, isa level, run_environment *out, diagnostic *why);
/* environment_read_machine: the fact `machine` of this machine, even if CUVETTE_NODE_TYPE is set; returns 0, or the
 * errno of a file that cannot be read now. environment_of_node_type: the fact `machine` of all nodes of a type.
 * environment_node_type: the value of CUVETTE_NODE_TYPE; NULL if it is unset or empty. */
int environment_read_machine(const char *root, char *text, size_t size);
void environment_of_node_type(const char *type, char *text, size_t size);
const char *environment_node_type(void);
/* The processing units that this process may use now, such as "0-3,8"; "unknown". STATUS_FAILURE as above. */
status environment_read_units(char *text, size_t size, diagnostic *why);
/* Computes the key from the facts. */
void environment_close(run_environment *e);
/* "build 1c… instead of 2d…, isa …": the differing facts, at most size - 1 bytes. False if there are none. */
bool environment_difference(const run_environment *a, const run_environment *b, char *text, size_t size);
