/* The JSON values of study/runs.h: what is recorded about the study, the machine and a run. No host name, serial number
 * or path of this machine. The caller owns them; NULL or a null value if memory runs out. */
#pragma once

#include "measure/topology.h"
#include "study/environment.h"
#include "study/study.h"
#include <jansson.h>

json_t *run_study_facts(const study *s);
json_t *run_machine_facts(const topology *machine);
json_t *run_facts(const study *s, const topology *machine, const run_environment *here, const char *id, long shard,
                  long shards);
/* The current time as text, or that of SOURCE_DATE_EPOCH (reproducible-builds.org/specs/source-date-epoch). */
json_t *run_time(void);
