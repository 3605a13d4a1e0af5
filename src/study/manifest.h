/* results/<study>/manifest.json: on what machine, with what program and from what files the rows came. Written
 * whole once, when the study first runs; each later run adds itself to the list `runs`, so that every row's
 * time_utc falls into one. It holds no host name, no serial number and no path of this machine. SOURCE_DATE_EPOCH,
 * if set, stands for the time. */
#ifndef CUVETTE_STUDY_MANIFEST_H
#define CUVETTE_STUDY_MANIFEST_H

#include "base/isa.h"
#include "measure/topology.h"
#include "study/study.h"

/* shard of shards, as in study_options. Waits while another shard's process writes it. */
status manifest_write(const study *s, const char *folder, const topology *machine, isa level, long shard, long shards,
                      diagnostic *why);

#endif
